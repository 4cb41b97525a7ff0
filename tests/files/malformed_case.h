/// malformed_case.h: files that must be refused, each in one sentence that names its fault.
#pragma once

#include "files/scene_io.h"
#include "surfels/errors.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <ostream>
#include <string>
#include <vector>

namespace surfelao::malformed {

/// A file that must be refused, and what the sentence must say beside the file's name.
struct Case {
    std::string name;  ///< of the test; the part up to the first '_' is the file's extension
    std::string contents;
    std::vector<std::string> words;

    friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

template <class... Values>
std::string bytes(Values... values)
{
    std::string text;
    const auto append = [&](auto value) {
        char raw[sizeof(value)];
        std::memcpy(raw, &value, sizeof(value));  // the machines of the tests are little-endian
        text.append(raw, sizeof(value));
    };
    (append(values), ...);
    return text;
}
static_assert(std::endian::native == std::endian::little);

inline std::string utf16(const std::string& text)
{
    std::string wide = "\xFF\xFE";
    for (const char c : text)
        wide += {c, '\0'};
    return wide;
}

inline void expect_refused(const Case& c)
{
    const TemporaryFolder folder;
    const std::string file_name = c.name + "." + c.name.substr(0, 3);
    const std::filesystem::path path = folder.file(file_name, c.contents);
    try {
        const Scene scene = read_scene(path);
        FAIL() << "read as " << scene.positions.size() << " vertices and " << scene.triangles.size()
               << " triangles";
    } catch (const InputError& error) {
        const std::string sentence = error.what();
        EXPECT_TRUE(sentence.starts_with(path.string() + ": ")) << sentence;
        const std::string fault = sentence.substr(std::min(sentence.size(), path.string().size()));
        for (const std::string& word : c.words)
            EXPECT_NE(fault.find(word), std::string::npos) << fault << "\nlacks " << word;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
        EXPECT_LT(fault.size(), 200u) << fault;
    }
}

}  // namespace surfelao::malformed
