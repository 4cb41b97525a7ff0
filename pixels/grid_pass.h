/// grid_pass.h: what objects with AO grids hide from what a picture sees, on the device.
///
/// A pass for each object draws the back faces of its box, without a depth test: every pixel of the
/// box once. Of the point that the pixel sees it reads the cells around with the device's own
/// filter, which is why the values are those of visibility_at() (placed_grid.h) to .003 only: cells
/// are halves, a cap cut by the horizon is told to .0011, and a GPU's filter has 8 bits.
#pragma once

#include "gpu/context.h"
#include "gpu/g_buffer.h"
#include "gpu/objects.h"
#include "pixels/placed_grid.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace surfelao {

/// Uses the context in every call.
class GridPass {
public:
    explicit GridPass(const GlContext& context);

    const GlContext& context() const { return context_; }

    /// As large as the picture: R32F.
    [[nodiscard]] Framebuffer make_target(int width, int height) const;

    /// The share of the light that the objects leave to every pixel; 1 on the background. seen:
    /// drawn, and as large as the target. Grids stay on the device from one drawing to the next.
    /// Union: costs a copy of the picture for each object besides.
    /// own: RG32F, as large: what the surface that a pixel looks at leaves of the light by itself,
    /// and its number (PlacedGrid::surface). Null: 1 and 0 everywhere.
    void draw(const GBuffer& seen, std::span<const PlacedGrid> objects, GridMerge merge,
              const Framebuffer& target, const Texture2D* own = nullptr);

private:
    struct Stored {
        std::shared_ptr<const AoGrid> grid;  ///< alive, so that its address is nobody else's
        std::vector<Texture3D> cells;        ///< one; of harmonics three
    };
    [[nodiscard]] const Stored& stored(const std::shared_ptr<const AoGrid>& grid);
    /// The program with all that tells of the object set.
    Program& program_for(const GBuffer& seen, const PlacedGrid& object, const Texture2D* own,
                         const char* fragment_file);
    void join(const GBuffer& seen, std::span<const PlacedGrid> objects, const Framebuffer& target,
              const Texture2D* own);

    const GlContext& context_;
    VertexArray nothing_;
    std::map<const AoGrid*, Stored> stored_;
    /// Of the union: joined so far, and with one object more.
    std::optional<std::pair<Framebuffer, Framebuffer>> joined_;
};

}  // namespace surfelao
