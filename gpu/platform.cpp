#include "gpu/platform.h"

#include "gpu/backends.h"

#include <dlfcn.h>

#include <utility>

namespace surfelao {

std::vector<std::string> installed_gl_backends()
{
    std::vector<std::string> names;
    for (const auto& [name, file] : {std::pair("EGL", kEglLibrary), {"OSMesa", kOsmesaLibrary}}) {
        if (SharedLibrary(file).error().empty())
            names.emplace_back(name);
    }
    return names;
}

void add_reason(std::string& reasons, const std::string& reason)
{
    if (!reasons.empty())
        reasons += "; ";
    reasons += reason;
}

SharedLibrary::SharedLibrary(const char* file)
    : file_(file), handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL))
{
    if (handle_ == nullptr)
        error_ = dlerror();
}

void* SharedLibrary::symbol(const char* name)
{
    if (handle_ == nullptr)
        return nullptr;
    void* found = dlsym(handle_, name);
    if (found == nullptr)
        error_ = file_ + " has no " + name;
    return found;
}

}  // namespace surfelao
