#include "gpu/platform.h"

#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <type_traits>
#include <vector>

namespace surfelao {
namespace {

#define SURFELAO_EGL_FUNCTIONS(X)     \
    X(BindAPI, BINDAPI)               \
    X(CreateContext, CREATECONTEXT)   \
    X(DestroyContext, DESTROYCONTEXT) \
    X(GetDisplay, GETDISPLAY)         \
    X(GetError, GETERROR)             \
    X(GetProcAddress, GETPROCADDRESS) \
    X(Initialize, INITIALIZE)         \
    X(MakeCurrent, MAKECURRENT)       \
    X(QueryString, QUERYSTRING)

struct Egl {
#define SURFELAO_EGL_MEMBER(name, upper) PFNEGL##upper##PROC name = nullptr;
    SURFELAO_EGL_FUNCTIONS(SURFELAO_EGL_MEMBER)
#undef SURFELAO_EGL_MEMBER
    // extensions: null where the library lacks them
    PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
    PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
    std::string error;  ///< why the functions are missing
};

/// Displays are never terminated: EGL hands out the same one to everyone who asks, so nobody knows
/// who is the last.
const Egl& egl()
{
    static const Egl loaded = [] {
        Egl result;
        // Mesa writes to the terminal what it also tells by errors; whoever wants to read it may
        // say so
        setenv("EGL_LOG_LEVEL", "fatal", 0);
        SharedLibrary library(kEglLibrary);
#define SURFELAO_EGL_FIND(name, upper) library.find(result.name, "egl" #name);
        SURFELAO_EGL_FUNCTIONS(SURFELAO_EGL_FIND)
#undef SURFELAO_EGL_FIND
        result.error = library.error();
        if (!result.error.empty())
            return result;
        const auto extension = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
                result.GetProcAddress(name));
        };
        extension(result.GetPlatformDisplay, "eglGetPlatformDisplayEXT");
        extension(result.QueryDevices, "eglQueryDevicesEXT");
        extension(result.QueryDeviceString, "eglQueryDeviceStringEXT");
        return result;
    }();
    return loaded;
}

/// Is `word` one of the space-separated words of `list`? A null list has none.
bool has_word(const char* list, std::string_view word)
{
    std::string_view rest = list != nullptr ? list : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, end) == word)
            return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

std::string last_error()
{
    char text[32];
    std::snprintf(text, sizeof text, "EGL error 0x%x", static_cast<unsigned>(egl().GetError()));
    return text;
}

class EglPlatform final : public GlPlatform {
public:
    EglPlatform(std::string name, EGLDisplay display, EGLContext context)
        : name_(std::move(name)), display_(display), context_(context)
    {
    }
    ~EglPlatform() override { egl().DestroyContext(display_, context_); }
    std::string name() const override { return name_; }
    void* get_proc(const char* name) const override
    {
        return reinterpret_cast<void*>(egl().GetProcAddress(name));
    }
    bool make_current() const override
    {
        return egl().BindAPI(EGL_OPENGL_API) == EGL_TRUE &&
               egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
    }
    void release() const override
    {
        egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    /// A 3.3 core context without a surface on the display, told of a device reset where that can
    /// be had.
    static std::unique_ptr<GlPlatform> make(const std::string& name, EGLDisplay display,
                                            std::string& reasons)
    {
        if (egl().BindAPI(EGL_OPENGL_API) != EGL_TRUE) {
            add_reason(reasons, name + ": has no OpenGL, " + last_error());
            return nullptr;
        }
        std::array<EGLint, 9> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                            3,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            3,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                            EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                            EGL_LOSE_CONTEXT_ON_RESET,
                                            EGL_NONE};
        EGLContext context =
            egl().CreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        if (context == EGL_NO_CONTEXT) {
            attributes[6] = EGL_NONE;
            context =
                egl().CreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        }
        if (context == EGL_NO_CONTEXT) {
            add_reason(reasons, name + ": makes no OpenGL 3.3 core context, " + last_error());
            return nullptr;
        }
        return std::make_unique<EglPlatform>(name, display, context);
    }

private:
    std::string name_;
    EGLDisplay display_;
    EGLContext context_;
};

/// A context on a display that is not started yet; null and a reason if it cannot be had.
std::unique_ptr<GlPlatform> make_on_display(const std::string& name, EGLDisplay display,
                                            std::string& reasons)
{
    const auto fail = [&](const std::string& reason) {
        add_reason(reasons, name + ": " + reason);
        return nullptr;
    };
    if (display == EGL_NO_DISPLAY)
        return fail("no such display");
    EGLint major = 0, minor = 0;
    if (egl().Initialize(display, &major, &minor) != EGL_TRUE)
        return fail("does not start, " + last_error());
    const char* extensions = egl().QueryString(display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_no_config_context") ||
        !has_word(extensions, "EGL_KHR_surfaceless_context"))
        return fail("cannot draw without a window");
    return EglPlatform::make(name, display, reasons);
}

std::vector<EGLDeviceEXT> all_devices()
{
    EGLint count = 0;
    if (egl().QueryDevices == nullptr || egl().QueryDeviceString == nullptr ||
        egl().QueryDevices(0, nullptr, &count) != EGL_TRUE)
        return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    egl().QueryDevices(count, devices.data(), &count);
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

}  // namespace

std::unique_ptr<GlPlatform> make_egl_platform(std::string& reasons)
{
    if (!egl().error.empty()) {
        add_reason(reasons, "EGL: " + egl().error);
        return nullptr;
    }
    const char* client = egl().QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);

    // real GPUs first; Mesa marks the device that is the CPU
    if (egl().GetPlatformDisplay != nullptr && has_word(client, "EGL_EXT_platform_device")) {
        const std::vector<EGLDeviceEXT> devices = all_devices();
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const char* kinds = egl().QueryDeviceString(devices[i], EGL_EXTENSIONS);
            if (has_word(kinds, "EGL_MESA_device_software"))
                continue;
            EGLDisplay display =
                egl().GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
            if (auto made = make_on_display("EGL device " + std::to_string(i), display, reasons))
                return made;
        }
    }
    if (egl().GetPlatformDisplay != nullptr && has_word(client, "EGL_MESA_platform_surfaceless")) {
        EGLDisplay display =
            egl().GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (auto made = make_on_display("EGL surfaceless", display, reasons))
            return made;
    }
    return make_on_display("EGL default display", egl().GetDisplay(EGL_DEFAULT_DISPLAY), reasons);
}

}  // namespace surfelao
