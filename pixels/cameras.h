/// cameras.h: from where a comparison looks.
#pragma once

#include "pixels/camera.h"

#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// text: what parse_camera() makes this camera of, so that any command can look from there.
struct NamedCamera {
    std::string text;
    Camera camera;
};

/// From directions all round, evenly spread, the scene framed: a Fibonacci lattice. The first looks
/// from an azimuth of 30 degrees, each further one is the golden angle on; their heights lie in the
/// middles of `count` equal slices of the unit ball, from the top down:
///
///     sin(elevation of k) = 1 - (2 k + 1) / count       4 views: 48.6, 14.5, -14.5, -48.6 degrees
///
/// Degrees have two decimals. count >= 1.
///
/// Based on:
///   Gonzalez. Measurement of Areas on a Sphere Using Fibonacci and Latitude-Longitude Lattices.
///   Mathematical Geosciences 42. 2010
[[nodiscard]] std::vector<NamedCamera> spread_cameras(int count, const CameraWishes& wishes);

/// One for each text. Throws as parse_camera().
[[nodiscard]] std::vector<NamedCamera> cameras_of(std::span<const std::string> texts,
                                                  const CameraWishes& wishes);

}  // namespace surfelao
