/// pixel_picture.h: a picture of what is asked at the pixels of a camera.
///
/// Every pixel's middle is asked, and a few more places where its samples see something else
/// (pixel_samples.h). Its value is the mean over those samples that see something, its alpha their
/// share. The picture is made in bands of rows, so that it may be of any size: memory is some 300
/// bytes a pixel of a band. The masks share work among the receivers of one list: at the border of
/// two bands answers differ by as much as any two lists make them.
///
/// A method that knows the picture alone answers at the middles of the samples' pictures: each
/// sample that another receiver comes from is a pass of its own. Its picture is one band.
#pragma once

#include "bake/error_search.h"
#include "bake/occluders.h"
#include "image/image.h"
#include "pixels/cube_projector.h"
#include "pixels/pixel_engine.h"
#include "pixels/pixel_samples.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Pixels of a band, whose receivers are held at once.
inline constexpr std::uint32_t kBandPixels = 2'000'000;

struct PixelPictureSettings {
    PictureSize size = {};                   ///< each way at least 1, of any size
    int samples = 16;                        ///< >= 1 a pixel: 1 = its middle alone
    std::optional<PixelEngine> engine = {};  ///< none: nothing is asked, all is open
    Definition definition = {};
    std::optional<std::uint32_t> reference_rays = {};  ///< ask them too; an even number
    Offset offset = {};
    int guard = 0;  ///< pixels beyond each edge, for screen-space methods
    std::uint32_t band_pixels = kBandPixels;
    /// Asked first, at the pixels' middles; the engine answers what they do not, or with
    /// white_holes nobody: all is open there. On this picture's context.
    CubeProjector* cube_maps = nullptr;
    bool white_holes = false;
};

/// One receiver's answers, as a colour is made of them.
struct AnsweredPixel {
    const Receiver& receiver;
    const Occlusion& value;
    const Occlusion& reference;         ///< the value where none was asked for
    bool is_hole = false;               ///< no cube map answered
    const GridPixels* grids = nullptr;  ///< who answered, if it was grids
    std::uint32_t surface = 0;          ///< GridWorld::surfaces_at() it
};

/// How answers become colours. Both are called from many threads.
struct PixelPaint {
    std::function<glm::vec3(const AnsweredPixel&)> color;
    BaseColorAt base = {};  ///< multiplies the colour, sample by sample; white where it is empty
};

struct PixelPicture {
    Image image;                ///< means of the paint's colours, straight alpha; nothing there: 0
    std::uint64_t middles = 0;  ///< receivers at pixels' middles
    std::uint64_t extras = 0;   ///< at other samples
    std::uint64_t edge_pixels = 0;  ///< that have such
    std::uint64_t holes = 0;        ///< middles that no cube map answered
    std::uint64_t faded = 0;        ///< middles that only fading cube maps answered
    int bands = 1;
    double prepare_s = 0.0;    ///< the engine's tree, and which triangles meet at edges
    double see_s = 0.0;        ///< drawing the middles, and their receivers
    double project_s = 0.0;    ///< cube maps at the middles
    double solve_s = 0.0;      ///< at the middles, or at the holes among them
    double edges_s = 0.0;      ///< all that the other samples cost
    double reference_s = 0.0;  ///< preparing and tracing
    double paint_s = 0.0;
};

/// view: of the whole picture. drawn: of the mesh, on this context. occluders: of mesh.occluding().
/// Throws as solve(), ScreenSpace::draw() and std::runtime_error where the device refuses;
/// InputError where a screen-space method's picture is larger than the device draws; Cancelled.
/// progress: "solve", "edges", "reference", band by band.
[[nodiscard]] PixelPicture pixel_picture(const GlContext& context, const Mesh& mesh,
                                         const DrawnMesh& drawn, Occluders& occluders,
                                         const View& view, const PixelPictureSettings& settings,
                                         const PixelPaint& paint,
                                         const StageProgress& progress = {});

}  // namespace surfelao
