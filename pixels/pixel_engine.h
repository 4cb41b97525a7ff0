/// pixel_engine.h: who answers the pixels of a picture, behind one door: an engine of the scene, a
/// method that knows the picture alone, or the AO grids of objects with an engine for the rest.
#pragma once

#include "bake/occluders.h"
#include "engines/engine.h"
#include "gpu/screen_space.h"
#include "pixels/grid_world.h"
#include "pixels/seen.h"
#include "surfels/progress.h"

#include <string>
#include <variant>
#include <vector>

namespace surfelao {

using PixelEngine = std::variant<EngineSettings, ScreenSettings, GridPixels>;

/// "masks", "gtao", "grid"
[[nodiscard]] std::string name_of(const PixelEngine& engine);
/// "good", "24 samples", "product"
[[nodiscard]] std::string setting_of(const PixelEngine& engine);

/// How large a picture is; each way at least 1 and at most what the device draws at once.
struct PictureSize {
    int width = 1280, height = 720;
    bool operator==(const PictureSize&) const = default;
};

/// The same scale, so many pixels wider on each side.
[[nodiscard]] View widened(View view, PictureSize size, int guard);
/// Of the pixels of a widened view those of the picture alone.
template <class T>
[[nodiscard]] std::vector<T> inner(std::vector<T> values, PictureSize size, int guard)
{
    if (guard == 0)
        return values;
    const auto columns = static_cast<std::size_t>(size.width + 2 * guard);
    const auto edge = static_cast<std::size_t>(guard);
    std::vector<T> result;
    for (std::size_t y = edge; y < edge + static_cast<std::size_t>(size.height); ++y) {
        const auto from = values.begin() + static_cast<std::ptrdiff_t>(y * columns + edge);
        result.insert(result.end(), from, from + size.width);
    }
    return result;
}

/// A mesh as one camera sees it: what all answers at the same pixels share.
class PixelView {
public:
    /// guard: pixels beyond each edge of the picture that screen-space methods see too.
    PixelView(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn, const View& view,
              PictureSize size, const Offset& offset = {}, int guard = 0);

    const SeenPixels& seen() const { return seen_; }       ///< of the picture, without the guard
    const GBuffer& g_buffer() const { return g_buffer_; }  ///< with it
    int guard() const { return guard_; }

    /// Values of a picture as large as the G-buffer, row 0 at the bottom, at seen().pixels.
    [[nodiscard]] std::vector<float> at_seen(const std::vector<float>& picture) const;

private:
    GBuffer g_buffer_;
    int guard_;
    SeenPixels seen_;
};

struct PixelAnswer {
    std::vector<Occlusion> values;  ///< one per seen pixel; of the screen's methods the bent normal
                                    ///< is zero
    double seconds = 0.0;           ///< of solving, or of the pass and of reading it back
};

/// occluders: of the mesh that the view is of. screen: of the view's context. Both engines measure
/// this definition. Not of GridPixels, which have an answer of their own. Throws as solve(), and as
/// ScreenSpace::draw().
[[nodiscard]] PixelAnswer answer(const PixelView& view, Occluders& occluders, ScreenSpace& screen,
                                 const PixelEngine& engine, const Definition& definition,
                                 const Progress& progress = {});

/// Of a world with grids. pass: of the view's context. Throws as solve_with_grids().
[[nodiscard]] PixelAnswer answer(const PixelView& view, GridPass& pass, const GridPixels& settings,
                                 const Definition& definition, const Progress& progress = {});

}  // namespace surfelao
