#include "files/gltf_strings.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What nlohmann's parser tells; it needs no recursion, so nesting may be as deep as it likes.
class Strings : public nlohmann::json_sax<json> {
public:
    explicit Strings(const VisitString& visit) : visit_(visit) {}

    bool string(std::string& text) override { return visit_(keys_, text); }
    bool key(std::string& name) override
    {
        keys_.back() = name;
        return true;
    }
    bool start_object(std::size_t) override { return enter(); }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t) override { return enter(); }
    bool end_array() override { return leave(); }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(std::int64_t) override { return true; }
    bool number_unsigned(std::uint64_t) override { return true; }
    bool number_float(double, const std::string&) override { return true; }
    bool binary(json::binary_t&) override { return true; }
    bool parse_error(std::size_t, const std::string&, const json::exception&) override
    {
        return false;
    }

private:
    bool enter()
    {
        keys_.emplace_back();
        return true;
    }
    bool leave()
    {
        keys_.pop_back();
        return true;
    }

    const VisitString& visit_;
    std::vector<std::string> keys_;
};

/// The size of the JSON chunk of a GLB of which the stream has given the first four bytes; at most
/// what the file holds.
std::size_t json_chunk_size(std::istream& file, std::uintmax_t bytes)
{
    unsigned char head[16] = {};  // version, length, and the chunk's size and type
    file.read(reinterpret_cast<char*>(head), sizeof head);
    std::uint64_t size = 0;
    for (int i = 0; i < 4; ++i)
        size |= std::uint64_t{head[8 + i]} << (8 * i);
    return static_cast<std::size_t>(std::min<std::uintmax_t>(size, bytes));
}

void visit_strings(std::istream& file, std::uintmax_t bytes, const VisitString& visit)
{
    char magic[4] = {};
    if (!file.read(magic, sizeof magic))
        return;
    Strings strings(visit);
    if (std::string_view(magic, sizeof magic) == "glTF") {
        std::string text(json_chunk_size(file, bytes), '\0');
        file.read(text.data(), static_cast<std::streamsize>(text.size()));
        static_cast<void>(json::sax_parse(text, &strings));
    } else {
        file.seekg(0);
        static_cast<void>(json::sax_parse(file, &strings));
    }
}

}  // namespace

void visit_gltf_strings(const fs::path& path, const VisitString& visit)
{
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        return;
    std::ifstream file(path, std::ios::binary);
    const std::uintmax_t bytes = fs::file_size(path, error);
    visit_strings(file, error ? 0 : bytes, visit);
}

void visit_gltf_strings_in(const std::string& contents, const VisitString& visit)
{
    std::istringstream file(contents);
    visit_strings(file, contents.size(), visit);
}

}  // namespace surfelao
