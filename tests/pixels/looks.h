/// looks.h: a mesh on the test's device, seen by a camera.
#pragma once

#include "gpu/g_buffer.h"
#include "pixels/pixel_engine.h"

#include "../gpu/contexts.h"
#include "scenes.h"

namespace surfelao {

/// A picture of a mesh.
struct Look {
    Look(const Mesh& mesh, const View& view, PictureSize size, int guard = 0)
        : drawn(test_context(), mesh.geometry, mesh.surface),
          pixels(test_context(), mesh, drawn, view, size, {}, guard)
    {
    }
    DrawnMesh drawn;
    PixelView pixels;
};

}  // namespace surfelao
