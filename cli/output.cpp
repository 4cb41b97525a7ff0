#include "cli/output.h"

#include "surfels/atomic_file.h"

#include <iostream>

namespace surfelao {

void check_report(const std::optional<std::string>& file)
{
    if (file && *file != "-")
        check_writable(*file);
}

void write_report(const std::string& file, const std::string& text)
{
    if (file == "-")
        std::cout << text;
    else
        write_atomically(file, text);
}

}  // namespace surfelao
