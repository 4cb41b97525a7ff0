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

// On failure all of these append the reason to `reasons`, which is a list for people to read.

inline constexpr const char* kOsmesaLibrary = "libOSMesa.so.8";
inline constexpr const char* kEglLibrary = "libEGL.so.1";

/// Null on failure.
std::unique_ptr<GlPlatform> make_osmesa_platform(std::string& reasons);
std::unique_ptr<GlPlatform> make_egl_platform(std::string& reasons);

/// "; " between the entries of such a list.
void add_reason(std::string& reasons, const std::string& reason);

/// A shared library that is opened when a context is first wanted, and never closed: its contexts
/// may outlive any owner.
class SharedLibrary {
public:
    explicit SharedLibrary(const char* file);

    /// Sets the pointer to that function, or to null.
    template <typename Function>
    void find(Function*& function, const char* name)
    {
        function = reinterpret_cast<Function*>(symbol(name));
    }

    /// Why the library or, the last of those asked for, a function is missing; else empty.
    const std::string& error() const { return error_; }

private:
    void* symbol(const char* name);
    std::string file_;
    void* handle_;
    std::string error_;
};

}  // namespace surfelao
