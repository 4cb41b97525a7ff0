/// text.h: numbers and tables for people and for CSV.
#pragma once

#include <string>
#include <vector>

namespace surfelao {

/// "0.0123"; never in the locale's manner.
[[nodiscard]] std::string fixed(double value, int digits);
/// The same with a sign: "+0.0012".
[[nodiscard]] std::string signed_fixed(double value, int digits);
/// The shortest text that reads back as the same number.
[[nodiscard]] std::string exact(double value);
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
