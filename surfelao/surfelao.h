/// surfelao.h: ambient occlusion and bent normals of triangle meshes, as a library.
///
///     find_package(surfelao REQUIRED)
///     target_link_libraries(mine PRIVATE surfelao::surfelao)
///     #include "surfelao/surfelao.h"
///
/// The way through it:
///
///     Scene                  triangles in world space: read_scene("mesh.ply"), or from arrays:
///                            make_scene(positions, triangles)
///     Mesh                   the same clean and welded, in the unit frame (mesh.geometry), with
///                            corner normals (mesh.surface): make_mesh(scene)
///     Prepared               what an engine builds of it, once: prepare(mesh.geometry, choice)
///     std::vector<Receiver>  where occlusion is asked for, each a point and a normal in the unit
///                            frame: receivers_at_wedges(mesh.geometry, mesh.surface), the
///                            vertices first, receivers_at() anywhere on the surface, or your own
///     Solution               an Occlusion for each receiver, in their order, as often as you like:
///                            solve(prepared, receivers, settings)
///     file                   write_scene("out.ply", scene, solution.occlusion), if you want one;
///                            what its colours show: files/vertex_colors.h
///
/// What is measured. surfels/occlusion.h is the definition: 0 is open, 1 is closed; the bent normal
/// points to the middle of what is open. Lengths (positions of receivers, offsets, max_distance)
/// are in diagonals of the scene's bounding box: geometry.frame turns world space into the unit
/// frame, unit = (world - centre) / diagonal, and definition_of() a user's distance into one.
///
/// Choices and settings. EngineChoice says who answers: masks (the default), disks (a preview) or
/// rays (any exactness), on the CPU or the GPU. SolveSettings say what is asked and how exactly;
/// `quality` is the one control of masks and disks (kDraft, kGood, kBest and between), `rays` that
/// of rays. engines/engine.h gives each member its range and its default.
///
/// Errors. Every function throws, none aborts:
///     SettingsError       a setting is out of its range; what() names both
///     InputError          a file or an array is no mesh, or a receiver no receiver; what() says
///                         which element and what was wanted
///     std::runtime_error  the machine: no memory on the device, no context, disk full
///     Cancelled           your Progress returned false
/// The library prints nothing. An object that has been moved from may only be destroyed or assigned
/// to.
///
/// Threads. Everything runs on all cores, by TBB; ThreadLimit (engines/threads.h) sets a limit.
/// Mesh and Prepared never change, so any number of threads may solve with one Prepared at once
/// on the CPU; on the GPU one at a time. Progress is called from any of these threads, one at a
/// time.
///
/// Determinism. Equal input and settings give equal bytes, whatever the number of threads, on the
/// same machine. Another processor may have other instructions: single bits of masks then differ
/// (Instructions::avx2 is what most machines have). GPUs differ in their last digits.
///
/// Costs. n vertices, r receivers. make_mesh O(n), mostly on one core; prepare O(n log n); solve
/// O(r log n), rays times `rays`. Masks keep at most 128 bytes a triangle, 250 while they build.
/// Times and errors, measured: docs/ of the source, and `surfelao compare` for your own mesh.
#pragma once

#include "engines/engine.h"
#include "engines/threads.h"
#include "files/scene_io.h"
#include "surfels/errors.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/scene.h"
#include "surfels/surface.h"
