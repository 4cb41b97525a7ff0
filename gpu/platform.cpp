#include "gpu/platform.h"

#include <dlfcn.h>

namespace surfelao {

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
