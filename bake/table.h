/// table.h: tables for people and for CSV.
#pragma once

#include <string>
#include <vector>

namespace surfelao {

/// Quoted where RFC 4180 wants it.
[[nodiscard]] std::string csv_field(const std::string& text);

/// Columns aligned: text left (the first two), numbers right.
class Table {
public:
    explicit Table(std::vector<std::string> names);
    void add(std::vector<std::string> cells);  ///< as many as names
    [[nodiscard]] std::string text() const;

private:
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace surfelao
