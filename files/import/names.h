/// names.h: names as glTF has them.
#pragma once

#include <string>
#include <string_view>

namespace surfelao {

/// Text that is UTF-8 as it is; other bytes are taken for Latin-1, which old formats have.
[[nodiscard]] std::string to_utf8(std::string_view text);

}  // namespace surfelao
