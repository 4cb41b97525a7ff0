/// context.h: an OpenGL 3.3 core context, wherever it comes from.
///
///   headless   EGL: a GPU by the device platform (no display needed), else Mesa's surfaceless
///              platform, else the default display; or OSMesa: software, always the same pixels
///   window     whoever made the window's context lends it: GlContext::adopt
///
/// libEGL and libOSMesa are opened when the first context is made, so a program that draws nothing
/// needs neither.
///
/// Nothing above gpu/ calls OpenGL. Objects (objects.h, program.h) belong to the context that they
/// were made with: it must be current whenever they are used or destroyed, and must outlive them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

struct GlTable;
class Program;

enum class GlBackend {
    automatic,  ///< EGL, and OSMesa where EGL has nothing to offer
    egl,
    osmesa,
};

/// What the device is and where its limits lie.
struct GlInfo {
    std::string platform;  ///< how the context was had: "OSMesa", "EGL device 0", "window", ...
    std::string renderer;  ///< the driver's own words
    std::string version;
    bool software = false;      ///< drawn by the CPU (llvmpipe and its kind)
    int max_texture_size = 0;   ///< widest and highest texture, framebuffer and viewport
    int max_buffer_texels = 0;  ///< longest texture buffer
};

/// How to get at a context that somebody else owns (a window). All three are called in the thread
/// that uses the context; they must stay valid as long as the GlContext.
struct ForeignContext {
    std::function<void*(const char* name)> get_proc;
    std::function<void()> make_current;
    std::function<void()> release;  ///< afterwards no context is current in this thread
};

/// Move-only. A context is current in at most one thread at a time; making one current releases the
/// GlContext that was current in this thread (OSMesa and GLX otherwise fight over it).
class GlContext {
public:
    /// Made current in this thread. Throws std::runtime_error saying what was tried and why each
    /// failed when there is none of at least OpenGL 3.3.
    [[nodiscard]] static GlContext create(GlBackend backend = GlBackend::automatic);

    /// Takes part in somebody else's context, and makes it current. Same errors.
    [[nodiscard]] static GlContext adopt(ForeignContext foreign);

    ~GlContext();
    GlContext(GlContext&&) noexcept;
    GlContext& operator=(GlContext&&) noexcept;

    /// For this thread. Throws std::runtime_error when the driver refuses.
    void make_current() const;

    /// So that another thread may take it. Does nothing when this context is not current here.
    void release() const;

    const GlInfo& info() const;

    /// Waits until everything asked for is done. Throws std::runtime_error naming `doing` when
    /// anything went wrong since the last check, a lost device included (where the driver tells).
    void finish(const char* doing) const;

    /// The program of these two files of shaders/ and definitions (program.h), made when first
    /// asked for and kept as long as the context: what it was set to by an earlier user is still
    /// set.
    Program& program(const std::string& vertex_file, const std::string& fragment_file,
                     const std::vector<std::string>& definitions = {}) const;

    /// For gpu/ alone (gl_table.inc).
    const GlTable& gl() const;

private:
    struct Impl;
    explicit GlContext(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
