#include "viewer/atlas_picture.h"

#include "image/color_map.h"
#include "image/lettering.h"
#include "surfels/errors.h"
#include "surfels/srgb.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

constexpr glm::vec4 kTable(0.02f, 0.021f, 0.023f, 1.0f);  ///< what the pages lie on
constexpr glm::vec3 kEmpty(0.05f);                        ///< of a page, where nothing is told
constexpr glm::vec3 kDarkLine(0.01f), kBrightLine(1.0f, 0.25f, 0.02f);
constexpr float kPaper = 0.94f;    ///< as in shaders/shading.glsl
constexpr float kDimmest = 0.25f;  ///< as in shaders/split_surface.frag
constexpr int kGap = 8;            ///< pixels between pages, and around them
constexpr int kMostSamples = 8;    ///< of a pixel, each way

/// Where pages lie in a picture: `columns` in a row, each of `size` pixels.
struct Sheet {
    glm::ivec2 size{1};
    int columns = 1;

    Sheet(const MapSize& map, int pages, glm::ivec2 room)
    {
        double best = 0.0;
        for (int across = 1; across <= pages; ++across) {
            const glm::ivec2 grid(across, (pages + across - 1) / across);
            const glm::dvec2 free = glm::dvec2(room - (grid + 1) * kGap) / glm::dvec2(grid);
            const double scale = std::min(free.x / map.width, free.y / map.height);
            if (scale <= best)
                continue;
            best = scale;
            columns = across;
            size = glm::max(glm::ivec2(1), glm::ivec2(scale * glm::dvec2(map.width, map.height)));
        }
        rows_ = (pages + columns - 1) / columns;
        room_ = room;
    }
    [[nodiscard]] glm::ivec2 corner(int page) const
    {
        const glm::ivec2 grid(columns, rows_);
        const glm::ivec2 all = grid * size + (grid - 1) * kGap;
        return (room_ - all) / 2 + glm::ivec2(page % columns, page / columns) * (size + kGap);
    }

private:
    int rows_ = 1;
    glm::ivec2 room_{1};
};

class PagePainter {
public:
    PagePainter(const Mesh& mesh, const SurfaceData& data, const ViewOptions& view)
        : mesh_(mesh), data_(data), view_(view)
    {
    }

    void paint(std::uint32_t page, glm::ivec2 corner, glm::ivec2 size, Image& image)
    {
        page_ = page;
        size_ = size;
        // of several sheets the first that covers most of the pixel
        std::vector<Texel> at(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
        const MapRaster raster(
            mesh_.geometry, data_.layout->layout.pages[page],
            {static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)});
        for (const Texel& texel : raster.texels(0, raster.size().height)) {
            Texel& seen = at[texel.y * static_cast<std::size_t>(size.x) + texel.x];
            if (texel.share > seen.share)
                seen = texel;
        }
        const std::vector<std::uint32_t>& charts = data_.layout->facts.charts[page];
        const auto chart_at = [&](glm::ivec2 pixel) {
            const bool is_on = pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y;
            const Texel& seen = at[is_on ? index(pixel) : 0];
            return is_on && seen.share > 0.0f ? charts[seen.point.triangle] : LayoutFacts::kNone;
        };
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec2 pixel(x, y);
                const std::uint32_t chart = chart_at(pixel);
                bool is_line = false;
                for (const glm::ivec2 step :
                     {glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(-1, 0), glm::ivec2(0, -1)})
                    is_line |= chart != LayoutFacts::kNone && chart_at(pixel + step) != chart;
                const glm::vec3 color = is_line ? line_color()
                                        : chart == LayoutFacts::kNone
                                            ? empty_color(pixel)
                                            : color_at(pixel, at[index(pixel)].point, chart);
                image.at(corner.x + x, corner.y + y) = glm::vec4(color, 1.0f);
            }
        }
    }

private:
    [[nodiscard]] std::size_t index(glm::ivec2 pixel) const
    {
        return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(pixel.x);
    }

    /// Colours that show the map's own numbers: all over the page.
    [[nodiscard]] bool is_grey() const
    {
        return view_.colors == Colors::visibility || view_.colors == Colors::rays ||
               view_.colors == Colors::levels || view_.colors == Colors::environment ||
               view_.colors == Colors::headlight;
    }

    [[nodiscard]] glm::vec3 line_color() const { return is_grey() ? kBrightLine : kDarkLine; }

    /// The mean over the pixel.
    [[nodiscard]] float fetch_pixel(const Map& map, std::uint32_t channel, glm::ivec2 pixel) const
    {
        const int across = std::clamp(static_cast<int>(map.width) / size_.x, 1, kMostSamples);
        double sum = 0.0;
        for (int i = 0; i < across * across; ++i) {
            const glm::dvec2 inside =
                (glm::dvec2(i % across, i / across) + 0.5) / static_cast<double>(across);
            sum += fetch(map, channel, (glm::dvec2(pixel) + inside) / glm::dvec2(size_));
        }
        return static_cast<float>(sum / (across * across));
    }

    [[nodiscard]] float visibility(glm::ivec2 pixel) const
    {
        return fetch_pixel(data_.map->visibility[page_], 0, pixel);
    }
    [[nodiscard]] float reference(glm::ivec2 pixel) const
    {
        const ModelMap& map = data_.reference ? *data_.reference : *data_.map;
        return fetch_pixel(map.visibility[page_], 0, pixel);
    }

    [[nodiscard]] glm::vec3 empty_color(glm::ivec2 pixel) const
    {
        return is_grey() ? grey(pixel) : kEmpty;
    }
    [[nodiscard]] glm::vec3 grey(glm::ivec2 pixel) const
    {
        const bool of_rays = view_.colors == Colors::rays;
        return glm::vec3(srgb_decode(kPaper * (of_rays ? reference(pixel) : visibility(pixel))));
    }

    /// The shown value is (d + 1) / 2.
    static glm::vec3 direction_color(glm::vec3 direction)
    {
        const float length = glm::length(direction);
        const glm::vec3 shown = 0.5f + 0.5f * (length > 0.0f ? direction / length : direction);
        return {srgb_decode(shown.x), srgb_decode(shown.y), srgb_decode(shown.z)};
    }

    [[nodiscard]] glm::vec3 normal_of(const SurfacePoint& point) const
    {
        const glm::uvec3 wedges = mesh_.surface.corners(mesh_.geometry)[point.triangle];
        const glm::vec3 weights(1.0f - point.at.x - point.at.y, point.at);
        glm::vec3 normal(0.0f);
        for (int k = 0; k < 3; ++k)
            normal += weights[k] * mesh_.surface.normals[wedges[k]];
        return normal;
    }

    [[nodiscard]] glm::vec3 color_at(glm::ivec2 pixel, const SurfacePoint& point,
                                     std::uint32_t chart) const
    {
        switch (view_.colors) {
            case Colors::difference:
                return map_color(
                    map_of(view_),
                    difference_place(map_of(view_), reference(pixel) - visibility(pixel),
                                     view_.difference_scale));
            case Colors::bent_normals: {
                glm::vec3 direction;
                for (int k = 0; k < 3; ++k)
                    direction[k] = 2.0f * fetch_pixel(data_.map->bent[page_],
                                                      static_cast<std::uint32_t>(k), pixel) -
                                   1.0f;
                return direction_color(direction);
            }
            case Colors::normals:
                return direction_color(normal_of(point));
            case Colors::charts:
                return label_color(chart) * glm::mix(visibility(pixel), 1.0f, kDimmest);
            case Colors::density:
                return map_color(view_.color_map,
                                 data_.layout->facts.densities[page_][point.triangle] /
                                     most_density(data_.layout->facts));
            case Colors::textured:
                return (data_.paint ? paint_at(*data_.paint, point) : glm::vec3(1.0f)) *
                       visibility(pixel);
            default:
                return grey(pixel);
        }
    }

    const Mesh& mesh_;
    const SurfaceData& data_;
    const ViewOptions& view_;
    std::uint32_t page_ = 0;
    glm::ivec2 size_{1};
};

}  // namespace

Image atlas_picture(const Mesh& mesh, const SurfaceData& data, const ViewOptions& view, int width,
                    int height)
{
    SURFELAO_CHECK(data.layout && data.map);
    const MapLayout& layout = data.layout->layout;
    Image image(width, height, kTable);
    const auto pages = static_cast<int>(layout.pages.size());
    const Sheet sheet(layout.size, pages, {width, height});
    PagePainter painter(mesh, data, view);
    for (int page = 0; page < pages; ++page) {
        const glm::ivec2 corner = sheet.corner(page);
        if (corner.x < 0 || corner.y < 0)  // a picture too small for all pages
            continue;
        painter.paint(static_cast<std::uint32_t>(page), corner, sheet.size, image);
        std::string name;
        if (layout.is_blended)
            name = std::string(1, "XYZ"[page]);
        else if (!layout.tiles.empty())
            name = std::to_string(layout.tiles[static_cast<std::size_t>(page)]);
        const int scale = std::max(1, height / 400);
        draw_text(image, corner + 4 * scale, name, glm::vec4(kBrightLine, 1.0f), scale);
    }
    return image;
}

}  // namespace surfelao
