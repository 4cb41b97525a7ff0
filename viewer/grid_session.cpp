#include "viewer/grid_session.h"

#include "bake/vertex_bake.h"
#include "pixels/grid_sources.h"
#include "surfels/geometry.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

std::size_t object_count(const GridQuestion& question)
{
    return question.objects ? question.objects->triangles.size() : 1;
}

/// Whether objects have the same grids in both.
bool have_same_settings(const GridQuestion& a, const GridQuestion& b)
{
    return a.model == b.model && a.grid == b.grid && a.engine == b.engine;
}

/// What an object leaves of the light at the corners of its triangles. alone: its mesh.
std::vector<glm::vec3> left_by_itself(std::shared_ptr<const Mesh> alone, TargetSettings settings,
                                      const EngineSettings& engine,
                                      const ObjectTriangles& triangles,
                                      const StageProgress& progress)
{
    settings.offset.reset();  // a length that may be larger than the object
    const VertexTarget target(alone, settings);
    const std::vector<Occlusion> values =
        bake_vertices(*alone, target, engine, {}, 0, progress).values;
    std::vector<glm::vec3> left;
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 corners = alone->scene.triangles[triangle];
        left.push_back(1.0f - glm::vec3(values[corners.x].occlusion, values[corners.y].occlusion,
                                        values[corners.z].occlusion));
    }
    return left;
}

ObjectGrid bake_object(const GridQuestion& question, std::size_t object,
                       const StageProgress& progress)
{
    const Model& model = *question.model;
    if (!question.objects)
        return {bake_grid(model.occluding(), question.grid, question.engine, 0, progress), {}};
    const ObjectTriangles& triangles = question.objects->triangles[object];
    std::vector<bool> others(model.mesh->scene.triangles.size(), true);
    for (const std::uint32_t triangle : triangles)
        others[triangle] = false;
    const auto alone = std::make_shared<const Mesh>(
        make_mesh(model.mesh->scene, model.settings.normals, {.left_out = std::move(others)}));
    EngineSettings engine = question.engine;
    engine.definition.max_distance *=
        static_cast<float>(model.geometry().frame.diagonal / alone->geometry.frame.diagonal);
    GridSettings of_one = question.grid;
    of_one.extent *= kMovingShare;
    GridBake grid = bake_grid(alone->geometry, of_one, engine, 0, progress);
    const auto at_end = [&](std::string_view, double) { return progress("repair", 1.0); };
    return {std::move(grid), left_by_itself(alone, model.settings, engine, triangles, at_end)};
}

void bake_missing(FoundGrids& grids, const Progress& progress)
{
    const auto missing =
        static_cast<double>(std::count(grids.bakes.begin(), grids.bakes.end(), nullptr));
    double made = 0.0;
    for (std::size_t object = 0; object < grids.bakes.size(); ++object) {
        if (grids.bakes[object])
            continue;
        const auto in_stage = [&](std::string_view stage, double done) {
            return progress((made + (stage == "repair" ? 1.0 : done)) / missing);  // it is short
        };
        grids.bakes[object] =
            std::make_shared<const ObjectGrid>(bake_object(grids.question, object, in_stage));
        made += 1.0;
    }
}

}  // namespace

void GridSession::ask(GridQuestion question)
{
    question.engine.definition.ground.reset();
    if (question == question_)
        return;
    question_ = std::move(question);
    start();
}

void GridSession::cancel()
{
    was_cancelled_ = worker_.busy();
    worker_.cancel();
}

void GridSession::ask_again()
{
    if (was_cancelled_)
        start();
}

std::shared_ptr<const ObjectGrid> GridSession::known(std::size_t object) const
{
    for (const auto& grids : {found_, before_}) {
        if (!grids || !have_same_settings(grids->question, question_))
            continue;
        const GridObjects* theirs = grids->question.objects.get();
        if (!theirs && !question_.objects)
            return grids->bakes.front();
        if (!theirs || !question_.objects)
            continue;
        const auto same =
            std::ranges::find(theirs->triangles, question_.objects->triangles[object]);
        if (same != theirs->triangles.end())
            return grids->bakes[static_cast<std::size_t>(same - theirs->triangles.begin())];
    }
    return nullptr;
}

void GridSession::start()
{
    message_.clear();
    was_cancelled_ = false;
    const std::uint64_t number = news_.ask();
    auto grids = std::make_shared<FoundGrids>();
    grids->question = question_;
    for (std::size_t object = 0; object < object_count(question_); ++object)
        grids->bakes.push_back(known(object));
    if (std::count(grids->bakes.begin(), grids->bakes.end(), nullptr) == 0) {
        worker_.cancel();
        take(std::move(grids));
        return;
    }
    worker_.start([this, number, grids](const Progress& progress) {
        News news;
        try {
            bake_missing(*grids, progress);
            news.found = grids;
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            news.failure = error.what();
        }
        news_.post(number, std::move(news));
    });
}

void GridSession::take(std::shared_ptr<const FoundGrids> found)
{
    before_ = std::exchange(found_, std::move(found));
    if (before_ && !(found_ && have_same_settings(before_->question, found_->question)))
        before_.reset();
}

void GridSession::forget()
{
    news_.ask();
    question_ = {};
    was_cancelled_ = false;
    found_.reset();
    before_.reset();
    message_.clear();
    worker_.cancel();
}

bool GridSession::update()
{
    const std::optional<News> news = news_.take();
    if (!news)
        return false;
    message_ = news->failure;
    take(news->found);
    return true;
}

}  // namespace surfelao
