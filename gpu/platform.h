/// platform.h: what a source of OpenGL contexts does; private to gpu/.
#pragma once

#include <memory>
#include <string>

namespace surfelao {

/// One context of OSMesa, EGL or a window. Destroyed when not current.
class GlPlatform {
public:
    virtual ~GlPlatform() = default;
    virtual std::string name() const = 0;
    virtual void* get_proc(const char* name) const = 0;
    virtual bool make_current() const = 0;  ///< false: the driver refuses
    virtual void release() const = 0;
};

/// Null on failure; the reason is then appended to `reasons`, which is a list for people to read.
std::unique_ptr<GlPlatform> make_osmesa_platform(std::string& reasons);
std::unique_ptr<GlPlatform> make_egl_platform(std::string& reasons);

/// "; " between the entries of such a list.
void add_reason(std::string& reasons, const std::string& reason);

}  // namespace surfelao
