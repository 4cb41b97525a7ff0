/// backends.h: which sources of OpenGL contexts this machine has.
#pragma once

#include <string>
#include <vector>

namespace surfelao {

/// "EGL", "OSMesa": those whose library can be loaded; whether it has a device is told by making a
/// context (gpu/context.h). OSMesa's takes some 50 ms.
[[nodiscard]] std::vector<std::string> installed_gl_backends();

}  // namespace surfelao
