#include "gpu/platform.h"

#include <array>

namespace surfelao {
namespace {

// GL/osmesa.h includes GL/gl.h, which clashes with GL/glcorearb.h: its few names stand here instead
using OsmesaContext = struct osmesa_context*;
using OsmesaProc = void (*)();
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaProfile = 0x33;
constexpr int kOsmesaCoreProfile = 0x34, kOsmesaMajor = 0x36, kOsmesaMinor = 0x37;
constexpr int kGlRgba = 0x1908, kGlUnsignedByte = 0x1401;

struct Osmesa {
    OsmesaContext (*create)(const int* attributes, OsmesaContext share) = nullptr;
    void (*destroy)(OsmesaContext) = nullptr;
    unsigned char (*make_current)(OsmesaContext, void* buffer, unsigned type, int width,
                                  int height) = nullptr;
    OsmesaProc (*get_proc)(const char* name) = nullptr;
    std::string error;  ///< why the functions are missing
};

const Osmesa& osmesa()
{
    static const Osmesa loaded = [] {
        Osmesa result;
        SharedLibrary library(kOsmesaLibrary);
        library.find(result.create, "OSMesaCreateContextAttribs");
        library.find(result.destroy, "OSMesaDestroyContext");
        library.find(result.make_current, "OSMesaMakeCurrent");
        library.find(result.get_proc, "OSMesaGetProcAddress");
        result.error = library.error();
        return result;
    }();
    return loaded;
}

class OsmesaPlatform final : public GlPlatform {
public:
    explicit OsmesaPlatform(OsmesaContext context) : context_(context) {}
    ~OsmesaPlatform() override { osmesa().destroy(context_); }
    std::string name() const override { return "OSMesa"; }
    void* get_proc(const char* name) const override
    {
        return reinterpret_cast<void*>(osmesa().get_proc(name));
    }
    bool make_current() const override
    {
        return osmesa().make_current(context_, pixels_.data(), kGlUnsignedByte, kSide, kSide) != 0;
    }
    void release() const override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

    /// A 3.3 core context.
    static std::unique_ptr<GlPlatform> make(std::string& reasons)
    {
        const int attributes[] = {kOsmesaFormat,
                                  kGlRgba,
                                  kOsmesaDepthBits,
                                  0,
                                  kOsmesaProfile,
                                  kOsmesaCoreProfile,
                                  kOsmesaMajor,
                                  3,
                                  kOsmesaMinor,
                                  3,
                                  0};
        OsmesaContext context = osmesa().create(attributes, nullptr);
        if (context == nullptr) {
            add_reason(reasons, "OSMesa: makes no OpenGL 3.3 core context");
            return nullptr;
        }
        return std::make_unique<OsmesaPlatform>(context);
    }

private:
    static constexpr int kSide = 4;  // nothing is drawn here: pictures go to framebuffer objects
    OsmesaContext context_;
    mutable std::array<unsigned char, 4 * kSide * kSide> pixels_{};
};

}  // namespace

std::unique_ptr<GlPlatform> make_osmesa_platform(std::string& reasons)
{
    if (!osmesa().error.empty()) {
        add_reason(reasons, "OSMesa: " + osmesa().error);
        return nullptr;
    }
    return OsmesaPlatform::make(reasons);
}

}  // namespace surfelao
