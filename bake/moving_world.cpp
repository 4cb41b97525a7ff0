#include "bake/moving_world.h"

#include "bake/moving_poses.h"
#include "bake/notes.h"
#include "bake/point_target.h"
#include "bake/roles.h"
#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// The same matrix for points of the unit frame.
glm::dmat4 in_unit_frame_of(const Frame& frame, const glm::dmat4& world)
{
    const glm::dmat3 linear(world);
    glm::dmat4 unit(linear);
    unit[3] = glm::dvec4(
        (linear * frame.centre + glm::dvec3(world[3]) - frame.centre) / frame.diagonal, 1.0);
    return unit;
}

/// The corners of a box, as something that has a lowest point.
Geometry corners_of(const Box& box, const Frame& frame)
{
    Geometry corners;
    corners.frame = frame;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const glm::dvec3 share(i & 1, i >> 1 & 1, i >> 2);
        corners.positions.emplace_back((glm::mix(box.low, box.high, share) - frame.centre) /
                                       frame.diagonal);
        corners.triangles.emplace_back(i, i, i);
    }
    return corners;
}

glm::dvec3 in_triangle(const std::vector<glm::dvec3>& positions, const glm::uvec3& t,
                       const glm::dvec2& at)
{
    return (1.0 - at.x - at.y) * positions[t.x] + at.x * positions[t.y] + at.y * positions[t.z];
}

/// t: the triangle that the piece lies in.
void add_piece(const CutOut::Piece& piece, const glm::uvec3& t, Scene& scene)
{
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::dvec2 at : piece.corners)
        scene.positions.push_back(in_triangle(scene.positions, t, at));
    scene.triangles.emplace_back(first, first + 1, first + 2);
}

}  // namespace

MovingWorld::MovingWorld(const std::filesystem::path& input, std::span<const double> seconds,
                         const TargetSettings& target, const PartChoice& parts,
                         const ReadOptions& reading)
{
    require(!seconds.empty(), "a sequence has one moment at least");
    rest_ = read_rest(input, reading);
    normals_ = target.normals;
    motion_ = std::make_unique<Motion>(rest_, reading.moment.value_or(Moment{}).animation);
    const std::vector<Scene> others = read_occluders(parts, reading);
    require(!rest_.triangles.empty(), rest_.name + ": has points only, no faces: it has no frames");
    check_target(rest_, target, parts);
    std::vector<Roles> roles = roles_of({&rest_, 1}, others, parts);
    std::vector<std::string> notes;
    open_materials(rest_, parts.clear, roles.front(), notes);
    rest_.notes.insert(rest_.notes.end(), notes.begin(), notes.end());
    check_baked(rest_, roles.front(), 1);
    const std::vector<bool> left_out = left_out_of(roles.front(), rest_.triangles.size());
    unbaked_ = roles.front().baked;
    unbaked_.flip();
    if (std::ranges::find(unbaked_, true) == unbaked_.end())
        unbaked_.clear();
    scan(seconds, left_out);
    occluders_.frame = frame_of(box_);
    offset_ = offset_of(target, occluders_.frame);
    for (std::uint32_t body = 0; body < body_count(); ++body)
        make_body(body, target, roles.front(), left_out);
    for (std::size_t i = 0; i < others.size(); ++i) {
        Roles& own = roles[i + 1];
        notes.clear();
        open_materials(others[i], parts.clear, own, notes);
        for (const std::string& note : notes)
            rest_.notes.push_back(others[i].name + ": " + note);
        Scene occluding;
        occluding.positions = others[i].positions;
        for (std::size_t t = 0; t < others[i].triangles.size(); ++t)
            if (own.occludes(t) && (own.cut.replaced.empty() || !own.cut.replaced[t]))
                occluding.triangles.push_back(others[i].triangles[t]);
        for (const CutOut::Piece& piece : own.cut.pieces)
            add_piece(piece, others[i].triangles[piece.triangle], occluding);
        add_occluders(occluding, 0);
    }
    occluding_positions_ = occluders_.positions;
    made_ = {};
    made_normals_ = {};
    poses_ = {};
}

/// Finds the box, and for each body the pose in which it is made and whether it is deformed.
void MovingWorld::scan(std::span<const double> seconds, const std::vector<bool>& left_out)
{
    bodies_.resize(motion_->body_count());
    for (std::uint32_t p = 0; p < rest_.parts.size(); ++p) {
        Body& body = bodies_[motion_->bodies()[p]];
        body.parts.push_back(p);
        body.is_soft = motion_->deforms()[p];
    }
    scene_ = rest_;
    made_ = rest_.positions;
    made_normals_ = rest_.normals.values;
    std::vector<bool> is_made(rest_.parts.size(), false);
    for (const double moment : seconds) {
        std::vector<PartPose> poses = motion_->at(moment);
        move_scene(rest_, *motion_, poses, scene_);
        poses_ = std::move(poses);
        include(scene_, poses_, left_out, box_);
        for (std::size_t p = 0; p < rest_.parts.size(); ++p) {
            const Part& part = rest_.parts[p];
            Body& body = bodies_[motion_->bodies()[p]];
            const PartPose& pose = poses_[p];
            // as pose() asks it, where the body is made already
            const bool is_even =
                placement_of(pose.from_rest * glm::inverse(body.from_rest)).has_value();
            if (!pose.is_gone && !is_even)
                body.is_soft = true;
            if (pose.is_gone || !is_even || is_made[p])
                continue;
            is_made[p] = true;
            body.from_rest = pose.from_rest;
            const auto copy = [&](const auto& from, auto& to) {
                std::copy_n(from.begin() + part.first_vertex, part.vertex_count,
                            to.begin() + part.first_vertex);
            };
            copy(scene_.positions, made_);
            if (!made_normals_.empty())
                copy(scene_.normals.values, made_normals_);
        }
    }
}

glm::vec3 MovingWorld::in_unit_frame(const glm::dvec3& position) const
{
    return glm::vec3((position - occluders_.frame.centre) / occluders_.frame.diagonal);
}

void MovingWorld::make_body(std::uint32_t number, const TargetSettings& target, const Roles& roles,
                            const std::vector<bool>& left_out)
{
    Body& body = bodies_[number];
    Scene own;
    own.name = rest_.name;
    std::vector<std::uint32_t> triangles;  // of the scene
    const bool is_turned = glm::determinant(glm::dmat3(body.from_rest)) < 0.0;
    for (const std::uint32_t p : body.parts) {
        const Part& part = rest_.parts[p];
        const auto first = static_cast<std::uint32_t>(own.positions.size());
        for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
            body.vertices.push_back(v);
            own.positions.push_back(made_[v]);
            if (!made_normals_.empty())
                own.normals.values.push_back(made_normals_[v]);
        }
        for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count;
             ++t) {
            triangles.push_back(t);
            glm::uvec3& own_triangle =
                own.triangles.emplace_back(rest_.triangles[t] - part.first_vertex + first);
            if (is_turned)
                std::swap(own_triangle.y, own_triangle.z);
        }
        Part& copy = own.parts.emplace_back(part);
        copy.first_vertex = first;
        copy.first_triangle =
            static_cast<std::uint32_t>(own.triangles.size()) - part.triangle_count;
    }

    Scene occluding;
    occluding.positions = own.positions;
    std::vector<bool> own_left_out(triangles.size(), false);
    bool is_any_baked = false;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const std::uint32_t in_scene = triangles[t];
        own_left_out[t] = !left_out.empty() && left_out[in_scene];
        is_any_baked = is_any_baked || roles.is_baked(in_scene);
        if (roles.occludes(in_scene) &&
            (roles.cut.replaced.empty() || !roles.cut.replaced[in_scene]))
            occluding.triangles.push_back(own.triangles[t]);
    }
    for (const CutOut::Piece& piece : roles.cut.pieces) {
        const auto found = std::ranges::lower_bound(triangles, piece.triangle);
        if (found == triangles.end() || *found != piece.triangle)
            continue;
        add_piece(piece, own.triangles[static_cast<std::size_t>(found - triangles.begin())],
                  occluding);
        for (const glm::dvec2 at : piece.corners)
            body.cut_corners.push_back({piece.triangle, at});
    }
    body.first_occluding_vertex = static_cast<std::uint32_t>(occluders_.positions.size());
    const std::size_t occluded = occluders_.triangles.size();
    add_occluders(occluding, number);
    body.first_receiver = receiver_count_;
    if (!is_any_baked)
        return;
    const bool is_any_left_out = std::ranges::find(own_left_out, true) != own_left_out.end();
    body.mesh = std::make_shared<Mesh>(
        make_mesh(std::move(own), target.normals,
                  {.frame = occluders_.frame,
                   .left_out = is_any_left_out ? std::move(own_left_out) : std::vector<bool>()}));
    if (!roles.baked.empty())
        keep_triangles(*body.mesh,
                       [&](std::size_t triangle) { return roles.is_baked(triangles[triangle]); });
    body.target = std::make_unique<VertexTarget>(body.mesh, target);
    receiver_count_ += body.target->receivers().size();
    if (number > 0 && occluders_.triangles.size() == occluded &&
        receiver_count_ > body.first_receiver)
        throw InputError(rest_.name + ": part " + rest_.parts[body.parts.front()].name +
                         " moves and is baked, but nothing that moves with it occludes");
    if (body.is_soft) {
        body.made_positions = body.mesh->geometry.positions;
        body.made_normals = body.mesh->surface.normals;
    }
}

void MovingWorld::add_occluders(const Scene& scene, std::uint32_t body)
{
    if (scene.positions.empty())
        return;
    const Geometry own = make_geometry(scene, {.frame = occluders_.frame});
    const auto first = static_cast<std::uint32_t>(occluders_.positions.size());
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(occluders_.positions, own.positions);
    append(occluders_.normals, own.normals);
    append(occluders_.areas, own.areas);
    for (const glm::uvec3 triangle : own.triangles)
        occluders_.triangles.push_back(triangle + first);
    for (const std::uint32_t welded : own.welded)
        occluders_.welded.push_back(welded + first);
    body_of_triangle_.resize(occluders_.triangles.size(), body);
}

Definition MovingWorld::definition_for(const DistanceLimit& limit, Kernel kernel,
                                       const std::optional<GroundPlane>& ground, float offset) const
{
    Definition definition = definition_of(limit, kernel, frame());
    const Geometry corners = corners_of(box_, frame());
    definition.ground = ground_of(ground, {corners}, offset);
    return definition;
}

const MovingWorld::Body& MovingWorld::owner_of(std::size_t receiver) const
{
    const auto found = std::ranges::find_if(bodies_, [&](const Body& body) {
        return body.target && receiver >= body.first_receiver &&
               receiver - body.first_receiver < body.target->receivers().size();
    });
    SURFELAO_CHECK(found != bodies_.end());
    return *found;
}

std::uint32_t MovingWorld::body_of(std::size_t receiver) const
{
    return static_cast<std::uint32_t>(&owner_of(receiver) - bodies_.data());
}

bool MovingWorld::has_normal(std::size_t receiver) const
{
    const Body& body = owner_of(receiver);
    return body.target->receivers()[receiver - body.first_receiver].normal != glm::vec3(0.0f);
}

std::vector<std::vector<std::uint32_t>> MovingWorld::neighbours() const
{
    std::vector<std::vector<std::uint32_t>> all(receiver_count_);
    for (const Body& body : bodies_) {
        if (!body.target || body.target->samples() == nullptr)
            continue;
        const Geometry& geometry = body.mesh->geometry;
        const std::vector<SurfacePoint>& points = body.target->samples()->points;
        const std::span<const Receiver> receivers = body.target->receivers();
        std::vector<std::vector<std::uint32_t>> at(geometry.positions.size());
        const auto corner = [&](std::size_t point, int i) {
            return geometry.welded[geometry.triangles[points[point].triangle][i]];
        };
        for (std::uint32_t point = 0; point < points.size(); ++point)
            for (int i = 0; i < 3; ++i)
                at[corner(point, i)].push_back(point);
        for (std::size_t point = 0; point < points.size(); ++point) {
            std::vector<std::uint32_t>& own = all[body.first_receiver + point];
            for (int i = 0; i < 3; ++i)
                for (const std::uint32_t other : at[corner(point, i)])
                    if (are_smooth(receivers[point].normal, receivers[other].normal, normals_))
                        own.push_back(static_cast<std::uint32_t>(body.first_receiver + other));
            std::ranges::sort(own);
            own.erase(std::unique(own.begin(), own.end()), own.end());
        }
    }
    if (std::ranges::all_of(all, [](const auto& list) { return list.empty(); }))
        all.clear();
    return all;
}

std::vector<Receiver> MovingWorld::receivers_now() const
{
    std::vector<Receiver> receivers;
    receivers.reserve(receiver_count_);
    for (const Body& body : bodies_) {
        if (!body.target)
            continue;
        for (const Receiver& receiver : body.target->receivers())
            receivers.push_back(&body == bodies_.data() ? receiver
                                                        : placed(receiver, body.placement));
    }
    return receivers;
}

std::uint64_t MovingWorld::triangle_count() const
{
    std::uint64_t count = 0;
    for (const Body& body : bodies_)
        count += body.mesh ? body.mesh->geometry.triangles.size() : 0;
    return count;
}

SurfaceCounts MovingWorld::counts() const
{
    SurfaceCounts counts;
    for (const Body& body : bodies_) {
        if (!body.mesh)
            continue;
        const Surface& surface = body.mesh->surface;
        counts.dropped_triangles += body.mesh->geometry.dropped_triangles;
        counts.corners_from_file += surface.corners_from_file;
        counts.replaced_corners += surface.replaced_corners;
        counts.vertices_without_normal += vertices_without_normal(*body.mesh);
    }
    return counts;
}

MovingScene MovingWorld::scene_for(const EngineChoice& choice) const
{
    return MovingScene(occluders_, body_of_triangle_, choice);
}

MovingReceivers MovingWorld::receivers_for(const MovingScene& scene,
                                           const MovingSettings& settings) const
{
    std::vector<Receiver> receivers;
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t number = 0; number < body_count(); ++number) {
        const Body& body = bodies_[number];
        if (!body.target)
            continue;
        const std::span<const Receiver> own = body.target->receivers();
        receivers.insert(receivers.end(), own.begin(), own.end());
        bodies.resize(receivers.size(), number);
    }
    return MovingReceivers(scene, std::move(receivers), std::move(bodies), settings);
}

void MovingWorld::pose(double seconds)
{
    std::vector<PartPose> poses = motion_->at(seconds);
    for (Body& body : bodies_)
        body.has_moved = poses_.empty();
    for (std::size_t p = 0; p < poses_.size(); ++p) {
        if (!is_same_pose(poses[p], poses_[p]))
            bodies_[motion_->bodies()[p]].has_moved = true;
    }
    move_scene(rest_, *motion_, poses, scene_);
    scene_.notes = rest_.notes;
    scene_.notes.push_back("the pose is that of " + motion_->text_at(seconds));
    poses_ = std::move(poses);
    for (std::size_t number = 1; number < bodies_.size(); ++number) {
        Body& body = bodies_[number];
        body.is_gone = std::ranges::all_of(
            body.parts, [&](std::uint32_t part) { return poses_[part].is_gone; });
        if (body.is_gone)
            continue;
        if (body.is_soft) {
            deform(body);
            continue;
        }
        const glm::dmat4 from_made =
            poses_[body.parts.front()].from_rest * glm::inverse(body.from_rest);
        body.placement = placement_of(in_unit_frame_of(occluders_.frame, from_made)).value();
        if (poses_[body.parts.front()].from_rest == body.from_rest)
            body.placement = {};
    }
}

void MovingWorld::deform(Body& body)
{
    std::uint32_t next = body.first_occluding_vertex;
    for (const std::uint32_t vertex : body.vertices)
        occluding_positions_[next++] = in_unit_frame(scene_.positions[vertex]);
    for (const InTriangle& corner : body.cut_corners) {
        const glm::uvec3 t = rest_.triangles[corner.triangle];
        occluding_positions_[next++] = in_unit_frame(in_triangle(scene_.positions, t, corner.at));
    }
    if (!body.target)
        return;
    for (std::size_t i = 0; i < body.vertices.size(); ++i)
        body.mesh->geometry.positions[i] = in_unit_frame(scene_.positions[body.vertices[i]]);
    follow_triangles(body.made_positions, body.made_normals, *body.mesh);
    body.target->follow_mesh();
}

void MovingWorld::place(MovingScene& scene, MovingReceivers* receivers) const
{
    for (std::uint32_t number = 1; number < std::min(body_count(), scene.body_count()); ++number) {
        const Body& body = bodies_[number];
        if (!body.has_moved)
            continue;
        if (body.is_gone) {
            scene.hide(number);
        } else if (body.is_soft) {
            scene.deform(number, occluding_positions_);
            if (body.target && receivers != nullptr)
                receivers->deform(number, body.target->receivers());
        } else {
            scene.place(number, body.placement);
        }
    }
}

Geometry MovingWorld::surface_now() const
{
    Geometry now;
    now.frame = occluders_.frame;
    for (const Body& body : bodies_) {
        if (!body.mesh)
            continue;
        const auto first = static_cast<std::uint32_t>(now.positions.size());
        for (const glm::vec3& position : body.mesh->geometry.positions)
            now.positions.push_back(placed({position, {}, 0.0f}, body.placement).position);
        for (const glm::uvec3 triangle : body.mesh->geometry.triangles)
            now.triangles.push_back(triangle + first);
    }
    return now;
}

std::vector<Occlusion> MovingWorld::on_surface(std::span<const Occlusion> values) const
{
    std::vector<Occlusion> found;
    for (const Body& body : bodies_) {
        if (!body.mesh)
            continue;
        for (const std::uint32_t vertex : body.vertices)
            found.push_back(values[vertex]);
    }
    return found;
}

double MovingWorld::mean_occlusion_of(std::span<const Occlusion> values) const
{
    double sum = 0.0;
    std::uint64_t count = 0;
    for (const Body& body : bodies_) {
        if (!body.mesh || body.is_gone)
            continue;
        for (std::size_t i = 0; i < body.vertices.size(); ++i) {
            if (body.mesh->surface.normals[i] == glm::vec3(0.0f))
                continue;
            sum += values[body.vertices[i]].occlusion;
            ++count;
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

std::optional<Misfit> MovingWorld::misfit(std::span<const Occlusion> answers,
                                          std::span<const Occlusion> values) const
{
    Misfit all;
    for (const Body& body : bodies_) {
        if (!body.target || body.is_gone)
            continue;
        std::vector<Occlusion> own_values;
        for (const std::uint32_t vertex : body.vertices)
            own_values.push_back(values[vertex]);
        const auto own = body.target->misfit(
            answers.subspan(body.first_receiver, body.target->receivers().size()), own_values);
        if (!own)
            continue;
        // its samples stand where it was made: placed, it may be of another size
        const double area = own->area * body.placement.scale * body.placement.scale;
        all.rms += area * own->rms * own->rms;
        all.share += area * own->share;
        all.area += area;
    }
    if (!(all.area > 0.0))
        return {};
    return Misfit{std::sqrt(all.rms / all.area), all.share / all.area, all.area};
}

Geometry MovingWorld::occluders_now() const
{
    Geometry now = occluders_;
    now.triangles.clear();
    std::vector<bool> is_done(now.positions.size(), false);
    for (std::size_t t = 0; t < occluders_.triangles.size(); ++t) {
        const Body& body = bodies_[body_of_triangle_[t]];
        if (body.is_gone)
            continue;
        const glm::uvec3 triangle = occluders_.triangles[t];
        now.triangles.push_back(triangle);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = triangle[corner];
            if (is_done[v] || body_of_triangle_[t] == 0)
                continue;
            is_done[v] = true;
            now.positions[v] =
                body.is_soft ? occluding_positions_[v]
                             : placed({occluders_.positions[v], {}, 0.0f}, body.placement).position;
        }
    }
    return now;
}

std::pair<const MovingWorld::Body*, std::uint32_t> MovingWorld::find_triangle(std::uint32_t t) const
{
    for (const Body& body : bodies_) {
        const auto count = body.mesh ? body.mesh->geometry.triangles.size() : std::size_t{0};
        if (t < count)
            return {&body, t};
        t -= static_cast<std::uint32_t>(count);
    }
    throw SettingsError("there is no such triangle");
}

std::vector<Receiver> MovingWorld::receivers_now(std::span<const SurfacePoint> points) const
{
    std::vector<Receiver> receivers;
    receivers.reserve(points.size());
    for (SurfacePoint point : points) {
        const auto [body, triangle] = find_triangle(point.triangle);
        point.triangle = triangle;
        const std::vector<Receiver> one =
            receivers_at(body->mesh->geometry, body->mesh->surface, {&point, 1}, offset_);
        receivers.push_back(placed(one.front(), body->placement));
    }
    return receivers;
}

const std::vector<Occlusion>& MovingValues::of(std::span<const Occlusion> answers)
{
    const bool is_first = answers_.empty();
    values_.resize(world_.rest_.positions.size());
    for (const MovingWorld::Body& body : world_.bodies_) {
        if (!body.target)
            continue;
        const std::size_t count = body.target->receivers().size();
        const std::span<const Occlusion> own = answers.subspan(body.first_receiver, count);
        const bool is_as_before =
            !is_first && !(body.is_soft && body.has_moved) &&
            std::ranges::equal(own, std::span(answers_).subspan(body.first_receiver, count));
        if (is_as_before)
            continue;
        // fits are made where the body was made: directions are turned there and back
        const glm::mat3 turn(body.placement.rotation);
        std::vector<Occlusion> turned(own.begin(), own.end());
        for (Occlusion& answer : turned)
            answer.bent_normal = glm::transpose(turn) * answer.bent_normal;
        const std::vector<Occlusion> values = body.target->values_locally(turned);
        for (std::size_t i = 0; i < values.size(); ++i)
            values_[body.vertices[i]] = {values[i].occlusion, turn * values[i].bent_normal};
    }
    answers_.assign(answers.begin(), answers.end());
    return values_;
}

}  // namespace surfelao
