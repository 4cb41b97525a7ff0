#include "gpu/context.h"

#include "gpu/gl_table.inc"
#include "gpu/platform.h"
#include "gpu/program.h"

#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

class ForeignPlatform final : public GlPlatform {
public:
    explicit ForeignPlatform(ForeignContext foreign) : foreign_(std::move(foreign)) {}
    std::string name() const override { return "window"; }
    void* get_proc(const char* name) const override { return foreign_.get_proc(name); }
    bool make_current() const override
    {
        foreign_.make_current();
        return true;
    }
    void release() const override { foreign_.release(); }

private:
    ForeignContext foreign_;
};

/// The platform whose context is current in this thread, as far as this file made it so.
thread_local const GlPlatform* current_platform = nullptr;

const char* error_name(GLenum error)
{
    switch (error) {
        case GL_INVALID_ENUM:
            return "invalid enum";
        case GL_INVALID_VALUE:
            return "invalid value";
        case GL_INVALID_OPERATION:
            return "invalid operation";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "invalid framebuffer operation";
        case GL_OUT_OF_MEMORY:
            return "out of memory";
        case GL_CONTEXT_LOST:
            return "device lost";
        default:
            return "unknown error";
    }
}

std::string text_of(const GlTable& gl, GLenum name)
{
    const GLubyte* text = gl.GetString(name);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "";
}

int integer_of(const GlTable& gl, GLenum name)
{
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

}  // namespace

void check_gl(const GlTable& gl, const char* doing)
{
    if (gl.GetGraphicsResetStatus != nullptr && gl.GetGraphicsResetStatus() != GL_NO_ERROR)
        throw std::runtime_error(std::string("OpenGL: the device was lost while ") + doing);
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR)
        return;
    // a lost context may report errors for ever
    for (int i = 0; i < 16 && gl.GetError() != GL_NO_ERROR; ++i) {
    }
    throw std::runtime_error(std::string("OpenGL: ") + error_name(error) + " while " + doing);
}

struct GlContext::Impl {
    std::unique_ptr<GlPlatform> platform;
    GlTable gl;
    GlInfo info;
    std::map<std::string, std::unique_ptr<Program>> programs;

    ~Impl()
    {
        if (!programs.empty() && current_platform != platform.get())
            make_current();
        programs.clear();
        release();
    }

    void make_current() const
    {
        if (current_platform == platform.get())
            return;
        if (current_platform != nullptr)
            current_platform->release();
        current_platform = nullptr;
        if (!platform->make_current())
            throw std::runtime_error("OpenGL: " + platform->name() +
                                     " does not let its context be used in this thread");
        current_platform = platform.get();
    }

    void release() const
    {
        if (platform == nullptr || current_platform != platform.get())
            return;
        platform->release();
        current_platform = nullptr;
    }

    void load()
    {
        const char* missing = nullptr;
#define SURFELAO_GL_LOAD(name, upper) \
    gl.name = reinterpret_cast<PFNGL##upper##PROC>(platform->get_proc("gl" #name));
        SURFELAO_GL_FUNCTIONS(SURFELAO_GL_LOAD)
        SURFELAO_GL_OPTIONAL_FUNCTIONS(SURFELAO_GL_LOAD)
#undef SURFELAO_GL_LOAD
#define SURFELAO_GL_TEST(name, upper) \
    if (gl.name == nullptr)           \
        missing = "gl" #name;
        SURFELAO_GL_FUNCTIONS(SURFELAO_GL_TEST)
#undef SURFELAO_GL_TEST
        if (missing != nullptr)
            throw std::runtime_error("OpenGL: " + platform->name() + " has no function " + missing +
                                     "; OpenGL 3.3 is needed");

        info.platform = platform->name();
        info.renderer = text_of(gl, GL_RENDERER);
        info.version = text_of(gl, GL_VERSION);
        if (integer_of(gl, GL_MAJOR_VERSION) * 10 + integer_of(gl, GL_MINOR_VERSION) < 33)
            throw std::runtime_error("OpenGL: " + platform->name() + " offers version '" +
                                     info.version + "'; OpenGL 3.3 is needed");
        // a pointer may be had for a function that this version of the context does not have
        if (integer_of(gl, GL_MAJOR_VERSION) * 10 + integer_of(gl, GL_MINOR_VERSION) < 45)
            gl.GetGraphicsResetStatus = nullptr;
        for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"})
            info.software = info.software || info.renderer.find(name) != std::string::npos;
        info.max_texture_size = integer_of(gl, GL_MAX_TEXTURE_SIZE);
        info.max_buffer_texels = integer_of(gl, GL_MAX_TEXTURE_BUFFER_SIZE);

        // the same in every context: rows without padding, seams of cube maps and the like unused
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        check_gl(gl, "asking what the device can do");
    }
};

GlContext::GlContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl))
{
    impl_->make_current();
    impl_->load();
}

GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;

GlContext GlContext::create(GlBackend backend)
{
    std::string reasons;
    for (auto* make : {&make_egl_platform, &make_osmesa_platform}) {
        if (backend != GlBackend::automatic &&
            (backend == GlBackend::egl) != (make == &make_egl_platform))
            continue;
        auto impl = std::make_unique<Impl>();
        impl->platform = make(reasons);
        if (impl->platform == nullptr)
            continue;
        try {
            return GlContext(std::move(impl));
        } catch (const std::runtime_error& error) {
            add_reason(reasons, error.what());
        }
    }
    throw std::runtime_error("no OpenGL context can be had: " + reasons);
}

GlContext GlContext::adopt(ForeignContext foreign)
{
    auto impl = std::make_unique<Impl>();
    impl->platform = std::make_unique<ForeignPlatform>(std::move(foreign));
    return GlContext(std::move(impl));
}

void GlContext::make_current() const
{
    impl_->make_current();
}
void GlContext::release() const
{
    impl_->release();
}
const GlInfo& GlContext::info() const
{
    return impl_->info;
}
const GlTable& GlContext::gl() const
{
    return impl_->gl;
}

Program& GlContext::program(const std::string& vertex_file, const std::string& fragment_file,
                            const std::vector<std::string>& definitions) const
{
    std::string key = vertex_file + ' ' + fragment_file;
    for (const std::string& definition : definitions)
        key += ' ' + definition;
    std::unique_ptr<Program>& kept = impl_->programs[key];
    if (kept == nullptr)
        kept = std::make_unique<Program>(*this, vertex_file, fragment_file, definitions);
    return *kept;
}

void GlContext::finish(const char* doing) const
{
    impl_->gl.Finish();
    check_gl(impl_->gl, doing);
}

}  // namespace surfelao
