#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/glm.hpp>
#include "engines/engine.h"
#include "family.h"
#include "files/scene_io.h"
#include "sampled_cloud.h"
#include "surfels/point_cloud.h"
#include "surfels/stopwatch.h"
#include "surfels/surface.h"
using namespace surfelao;
struct Row {
    double rmse, max, bias, wrong, weak, ang, proj, uneven, outl;
    double t_make, t_orient, t_build, t_solve;
};
static float g_q = 1;
static std::vector<std::uint32_t> all_of(const PointCloud& c)
{
    std::vector<std::uint32_t> v(c.positions.size());
    for (std::uint32_t i = 0; i < v.size(); i++)
        v[i] = i;
    return v;
}
static std::vector<Occlusion> solve_cloud(const PointCloud& c, const std::vector<Receiver>& r,
                                          double* tb = nullptr, double* ts = nullptr, float q = -9,
                                          Engine e = Engine::masks)
{
    Stopwatch w;
    Geometry sq = squares_of(c);
    EngineChoice ch;
    ch.engine = e;
    Prepared p = prepare(c, sq, ch);
    if (tb)
        *tb = w.lap();
    SolveSettings s;
    s.quality = q > -9 ? q : g_q;
    s.rays = 512;
    auto a = solve(p, r, s).occlusion;
    if (ts)
        *ts = w.lap();
    return a;
}
static void orient_cloud(PointCloud& c, float q)
{
    if (!c.is_unoriented)
        return;
    auto all = receivers_at(c, all_of(c));
    std::vector<Receiver> f, b;
    for (auto i : c.occluders) {
        f.push_back(all[i]);
        Receiver r = all[i];
        r.position -= 2 * r.offset * r.normal;
        r.normal = -r.normal;
        b.push_back(r);
    }
    Geometry sq = squares_of(c);
    Prepared p = prepare(c, sq, {});
    SolveSettings s;
    s.quality = q;
    auto A = solve(p, f, s).occlusion, B = solve(p, b, s).occlusion;
    orient(c, A, B);
}
static Row row(const Mesh& m, const scenes::CloudSampling& cs, const PointSettings& ps,
               float oq = 0, Engine e = Engine::masks)
{
    auto s = scenes::sampled(m, cs);
    auto tr = receivers_at(m.geometry, m.surface, s.samples);
    SolveSettings b;
    b.quality = 2;
    auto T = solve(prepare(m.geometry), tr, b).occlusion;
    Row r{};
    Stopwatch w;
    PointCloud c = make_point_cloud(s.cloud, ps);
    r.t_make = w.lap();
    orient_cloud(c, oq);
    r.t_orient = w.lap();
    auto A = solve_cloud(c, receivers_at(c, all_of(c)), &r.t_build, &r.t_solve, -9, e);
    double se = 0, bi = 0;
    size_t n = T.size();
    std::vector<double> er;
    for (size_t i = 0; i < n; i++) {
        double d = A[i].occlusion - T[i].occlusion;
        se += d * d;
        bi += d;
        r.max = std::max(r.max, std::abs(d));
        float dt = glm::dot(c.normals[i], tr[i].normal);
        r.wrong += dt < 0;
        r.ang += std::acos(std::clamp(std::abs(dt), 0.f, 1.f)) * 57.3 / n;
    }
    r.rmse = std::sqrt(se / n);
    r.bias = bi / n;
    r.wrong /= n;
    r.weak = double(c.counts.weak) / n;
    r.proj = c.is_flattened;
    r.uneven = double(c.counts.uneven) / n;
    r.outl = double(c.counts.outliers) / n;
    return r;
}
static void show(const char* what, const Row& r)
{
    std::printf(
        "%-34s rmse %.4f max %.2f bias %+.4f wrong %.3f%% weak %.2f%% ang %.1f proj %.1f%% uneven "
        "%.1f%% outl %.2f%% | make %.3f orient %.3f build %.3f solve %.3f\n",
        what, r.rmse, r.max, r.bias, 100 * r.wrong, 100 * r.weak, r.ang, 100 * r.proj,
        100 * r.uneven, 100 * r.outl, r.t_make, r.t_orient, r.t_build, r.t_solve);
    std::fflush(stdout);
}
int main(int c, char** v)
{
    std::string mode = v[1];
    if (getenv("LIFT"))
        kLift = atof(getenv("LIFT"));
    if (getenv("F"))
        kSquareShare = atof(getenv("F"));
    if (getenv("FU"))
        kUnevenShare = atof(getenv("FU"));
    if (getenv("SC"))
        kScatter = atof(getenv("SC"));
    if (getenv("UN"))
        kUneven = atof(getenv("UN"));
    if (getenv("Q"))
        g_q = atof(getenv("Q"));
    if (mode == "mesh")
        for (int i = 2; i < c; i++) {
            Mesh m = make_mesh(read_scene(v[i]));
            unsigned N = getenv("N") ? atoi(getenv("N")) : 50000;
            std::puts(v[i]);
            show("normals", row(m, {.points = N}, {}));
            show("normals, rays", row(m, {.points = N}, {}, 0, Engine::rays));
            show("normals, disks", row(m, {.points = N}, {}, 0, Engine::disks));
            show("no normals", row(m, {.points = N, .has_normals = false}, {}));
            show("noise .3 no normals",
                 row(m, {.points = N, .noise = .3, .has_normals = false}, {}));
            show("noise .3 no normals rays",
                 row(m, {.points = N, .noise = .3, .has_normals = false}, {}, 0, Engine::rays));
        }
    if (mode == "verts") {
        double lg = 0;
        int n = 0;
        double un = 0;
        for (unsigned i = 0; i < scenes::kFamilySize; i++) {
            if (scenes::half_of(i) != scenes::Half::choosing || (i / 16) % 5 >= 1)
                continue;
            Mesh m = make_mesh(scenes::family_scene(i));
            auto rec = receivers_at_wedges(m.geometry, m.surface);
            rec.resize(m.surface.vertex_count());
            SolveSettings b;
            b.quality = 2;
            auto T = solve(prepare(m.geometry), rec, b).occlusion;
            Scene s;
            s.positions = m.scene.positions;
            s.normals.values.assign(m.surface.normals.begin(),
                                    m.surface.normals.begin() + rec.size());
            PointCloud pc = make_point_cloud(s, {});
            auto A = solve_cloud(pc, receivers_at(pc, all_of(pc)));
            double se = 0;
            for (size_t k = 0; k < T.size(); k++)
                se += (A[k].occlusion - T[k].occlusion) * (A[k].occlusion - T[k].occlusion);
            double rm = std::sqrt(se / T.size());
            lg += std::log(std::max(rm, 1e-4));
            un += double(pc.counts.uneven) / T.size();
            n++;
            if (getenv("V"))
                std::printf("%s %.4f uneven %.3f\n", scenes::family_kind(i), rm,
                            double(pc.counts.uneven) / T.size());
        }
        std::printf("verts geomean %.5f uneven %.3f n %d\n", std::exp(lg / n), un / n, n);
    }
    if (mode == "family") {
        int half = atoi(v[2]);
        int step = c > 3 ? atoi(v[3]) : 16;
        double se[3] = {}, bi[3] = {};
        int n = 0;
        for (unsigned i = 0; i < scenes::kFamilySize; i += 1) {
            if ((scenes::half_of(i) == scenes::Half::choosing) != (half == 0))
                continue;
            if ((i / 16) % 5 >= unsigned(step))
                continue;
            Mesh m = make_mesh(scenes::family_scene(i));
            Row r[3] = {row(m, {.points = 20000}, {}),
                        row(m, {.points = 20000, .has_normals = false}, {}),
                        row(m, {.points = 20000, .noise = .3, .has_normals = false}, {})};
            for (int k = 0; k < 3; k++) {
                se[k] += r[k].rmse;
                bi[k] += r[k].bias;
            }
            n++;
            if (getenv("V")) {
                show(scenes::family_kind(i), r[0]);
                show("  none", r[1]);
                show("  noise", r[2]);
            }
        }
        std::printf("family %d: n %d normals %.4f %+.4f none %.4f %+.4f noise %.4f %+.4f\n", half,
                    n, se[0] / n, bi[0] / n, se[1] / n, bi[1] / n, se[2] / n, bi[2] / n);
    }
}
