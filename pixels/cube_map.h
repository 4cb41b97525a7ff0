/// cube_map.h: ambient occlusion round a place, found once and shown from anywhere: it does not
/// depend on the eye.
///
/// A *cube map* is a centre and what six square pictures of 90 degrees round it see. Every texel
/// that sees something is a receiver (pixels/seen.h), answered by any engine once. Afterwards a
/// camera's pixels read the maps (cube_projector.h) instead of being solved; those that no map sees
/// are *holes* (cube_answer.h). Where maps should be: cube_placement.h.
///
///          ┌───┐            face 2a looks along +axis a, 2a + 1 along -axis a
///      ┌───┤+y ├───┬───┐    texel x + size (y + size face), row 0 of a face at the bottom
///      │-x │+z │+x │-z │    footprint of a texel at the distance r: 2 r / size
///      └───┤-y ├───┴───┘
///          └───┘
///
/// A window adds a map in two steps, so that a thread without a context can solve:
///
///     const CubeSight sight = look_around(context, mesh, drawn, centre, size);  // context's
///     thread const Solution solution = solve(prepared, sight.receivers, settings);     // any
///     thread projector.add(cube_map_of(sight, solution.occlusion));                    //
///     context's thread projector.project(view.g_buffer(), target); // each frame
///
/// Lengths in diagonals.
///
/// Based on:
///   Oswald. Cube Map Ambient Occlusion. Master's thesis, TU Graz. 2010
/// which keeps the same bytes a texel, but a hash of the normal that many normals share, and solves
/// texels by horizons in their own face.
#pragma once

#include "pixels/pixel_engine.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

inline constexpr int kCubeFaces = 6;
/// Texels along the edge of a face.
inline constexpr int kCubeSize = 256, kLeastCubeSize = 16, kMostCubeSize = 1024;

/// A face as a camera sees it. face: 0 to 5.
[[nodiscard]] View face_view(glm::vec3 centre, int face);

/// Seven bytes a texel.
struct CubeMap {
    glm::vec3 centre{0.0f};
    int size = 0;
    std::vector<float> distances;         ///< from the centre; kNothingThere for the background
    std::vector<std::uint8_t> occlusion;  ///< 255 = closed
    std::vector<glm::u8vec2> normals;     ///< towards the centre's side, octahedral

    [[nodiscard]] std::size_t bytes() const;
};

/// A direction as two bytes: the octahedron |x| + |y| + |z| = 1, its lower half folded outwards
/// (Cigolle et al. Survey of Efficient Representations for Independent Unit Vectors. JCGT 3(2).
/// 2014). Off by less than a degree. direction: of unit length.
[[nodiscard]] glm::u8vec2 octahedral_of(glm::vec3 direction);
[[nodiscard]] glm::vec3 direction_of(glm::u8vec2 octahedral);

/// What a map sees before anybody has answered.
struct CubeSight {
    glm::vec3 centre{0.0f};
    int size = 0;
    std::vector<std::uint32_t> texels;                ///< that see something, rising
    std::vector<float> distances;                     ///< one per such texel
    std::vector<Receiver> receivers;                  ///< likewise
    std::array<std::size_t, kCubeFaces + 1> faces{};  ///< face f has texels[faces[f]] to
                                                      ///< texels[faces[f + 1] - 1]
    bool is_inside = false;  ///< all there is around are back sides: of a closed body, from inside
};

/// size: kLeastCubeSize to kMostCubeSize, or SettingsError. mesh: drawn.
[[nodiscard]] CubeSight look_around(const GlContext& context, const Mesh& mesh,
                                    const DrawnMesh& drawn, glm::vec3 centre, int size,
                                    const Offset& offset = {});

/// answers: one per receiver.
[[nodiscard]] CubeMap cube_map_of(const CubeSight& sight, std::span<const Occlusion> answers);

/// Everything that maps of one scene have in common; references must outlive what is made.
struct CubeWorld {
    const GlContext& context;
    const Mesh& mesh;
    const DrawnMesh& drawn;
    Occluders& occluders;  ///< of the mesh
    ScreenSpace& screen;   ///< of the context
};

/// An engine that runs on the device runs in the world's context.
[[nodiscard]] EngineSettings engine_of(const CubeWorld& world, EngineSettings engine,
                                       const Definition& definition);

struct CubeSettings {
    PixelEngine engine = EngineSettings{};
    Definition definition = {};
    int size = kCubeSize;
    Offset offset = {};
};

/// The engine of the thesis: horizons in 15 directions, 15 steps each, within the face. Its
/// integral is hbao's (gpu/screen_space.h).
[[nodiscard]] ScreenSettings cube_horizon();

struct CubeSeconds {
    double draw = 0.0;   ///< faces, and receivers of their texels
    double solve = 0.0;  ///< texels
};

/// A map with its answers. The engine is prepared with the first one. Throws InputError where the
/// centre is inside of a closed body, or sees nothing; else as look_around() and answer().
[[nodiscard]] CubeMap make_cube_map(const CubeWorld& world, glm::vec3 centre,
                                    const CubeSettings& settings, CubeSeconds& seconds,
                                    const Progress& progress = {});

}  // namespace surfelao
