#include "reference/reference_cache.h"

#include "differences.h"
#include "reference/rays.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "temporary_folder.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// A cache folder of its own for every test.
class ReferenceCache : public testing::Test {
protected:
    void SetUp() override { setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1); }
    void TearDown() override { unsetenv("XDG_CACHE_HOME"); }

    Reference trace(std::uint32_t rays = 64, bool use_cache = true) const
    {
        ReferenceOptions options;
        options.rays = rays;
        options.use_cache = use_cache;
        return trace_reference(geometry_, receivers_, options);
    }
    std::vector<fs::path> files() const
    {
        std::vector<fs::path> result;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path())) {
            if (entry.is_regular_file())
                result.push_back(entry.path());
        }
        return result;
    }

    TemporaryFolder folder_;
    Geometry geometry_ = make_geometry(scenes::bumpy_sphere(8));
    std::vector<Receiver> receivers_ = vertex_receivers(geometry_);
};

bool same_bytes(const Reference& a, const Reference& b)
{
    return same_bytes(a.occlusion, b.occlusion) && a.noise == b.noise && a.change == b.change &&
           a.half_difference == b.half_difference;
}

TEST_F(ReferenceCache, SecondTimeComesFromTheFileWithTheSameBytes)
{
    const Reference first = trace();
    EXPECT_FALSE(first.from_cache);
    ASSERT_EQ(files().size(), 1u);
    const Reference second = trace();
    EXPECT_TRUE(second.from_cache);
    EXPECT_TRUE(same_bytes(first, second));
}

TEST_F(ReferenceCache, AnythingElseAskedIsAnotherFile)
{
    static_cast<void>(trace(64));
    EXPECT_FALSE(trace(32).from_cache);
    ReferenceOptions limited;
    limited.rays = 64;
    limited.definition.max_distance = 0.5f;
    EXPECT_FALSE(trace_reference(geometry_, receivers_, limited).from_cache);
    for (const float height : {-0.6f, -0.7f}) {
        limited.definition.ground = Ground{{0, 0, 1}, height};
        EXPECT_FALSE(trace_reference(geometry_, receivers_, limited).from_cache);
    }
    receivers_[3].position.x += 1e-3f;
    EXPECT_FALSE(trace(64).from_cache);
    geometry_.positions[5].x += 1e-3f;
    EXPECT_FALSE(trace(64).from_cache);
    EXPECT_EQ(files().size(), 7u);
}

TEST_F(ReferenceCache, DamagedFilesAreTracedAnewAndReplaced)
{
    const Reference first = trace();
    const fs::path file = files().at(0);
    const std::uint64_t size = fs::file_size(file);
    const auto damage = [&](std::uint64_t at) {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(static_cast<std::streamoff>(at));
        const char byte = static_cast<char>(stream.get());
        stream.seekp(static_cast<std::streamoff>(at));
        stream.put(static_cast<char>(byte ^ 0x10));
    };
    const std::function<void()> faults[] = {
        [&] { fs::resize_file(file, size - 1); },
        [&] { fs::resize_file(file, 0); },
        [&] { fs::resize_file(file, size + 1); },
        [&] { damage(0); },
        [&] { damage(8); },
        [&] { damage(20); },
        [&] { damage(45); },
        [&] { damage(size / 2); },
        [&] { damage(size - 1); },
    };
    for (const auto& fault : faults) {
        fault();
        const Reference again = trace();
        EXPECT_FALSE(again.from_cache);
        EXPECT_TRUE(same_bytes(first, again));
        EXPECT_TRUE(trace().from_cache);  // it was replaced
    }
}

TEST_F(ReferenceCache, CanBeDoneWithout)
{
    static_cast<void>(trace(64, false));
    EXPECT_TRUE(files().empty());
    setenv("XDG_CACHE_HOME", "/proc/none", 1);  // a folder that nobody can make
    EXPECT_FALSE(trace().from_cache);
}

TEST_F(ReferenceCache, FolderFollowsTheXdgSpecification)
{
    EXPECT_EQ(cache_folder(), folder_ / "surfelao");
    setenv("XDG_CACHE_HOME", "relative", 1);
    const char* home = std::getenv("HOME");
    const std::string saved = home != nullptr ? home : "";
    setenv("HOME", "/somewhere", 1);
    EXPECT_EQ(cache_folder(), fs::path("/somewhere/.cache/surfelao"));
    unsetenv("HOME");
    EXPECT_EQ(cache_folder(), fs::path());
    if (home != nullptr)
        setenv("HOME", saved.c_str(), 1);
}

// The stated noise is the real one: RMS distance to a far better answer, within a factor of 1.5
// (the two halves' difference is one draw of some hundred vertices).
TEST_F(ReferenceCache, StatedNoiseIsTheRealOne)
{
    RayOptions better;
    better.rays = 16384;
    better.seed = 99;
    const std::vector<Occlusion> truth =
        trace_occlusion(RayScene(geometry_, RayScene::Build::robust), receivers_, better);
    for (const std::uint32_t rays : {64u, 512u}) {
        const Reference reference = trace(rays);
        double squares = 0.0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            squares += std::pow(reference.occlusion[i].occlusion - truth[i].occlusion, 2);
        const double real = std::sqrt(squares / static_cast<double>(truth.size()));
        EXPECT_LT(reference.noise, 1.5 * real) << rays;
        EXPECT_GT(reference.noise, real / 1.5) << rays;
    }
}

// As noisy as their mean, receiver by receiver.
TEST_F(ReferenceCache, HalvesDifferAsMuchAsTheNoiseSays)
{
    const Reference reference = trace(64);
    ASSERT_EQ(reference.half_difference.size(), receivers_.size());
    double squares = 0.0;
    for (const float difference : reference.half_difference)
        squares += difference * difference;
    EXPECT_GT(reference.noise, 0.0);
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(receivers_.size())), reference.noise, 1e-7);
}

TEST_F(ReferenceCache, IllDefinedReceiversNeedNotBeFound)
{
    ReferenceOptions options;
    options.rays = 64;
    options.find_ill_defined = false;
    const auto without = [&] { return trace_reference(geometry_, receivers_, options); };
    const Reference first = without();
    EXPECT_TRUE(first.change.empty());
    EXPECT_TRUE(first.well_defined(0));
    EXPECT_TRUE(same_bytes(first.occlusion, trace(64).occlusion));
    const Reference second = without();
    EXPECT_TRUE(second.from_cache);
    EXPECT_TRUE(same_bytes(first, second));
    EXPECT_EQ(files().size(), 2u);
}

TEST_F(ReferenceCache, CancelledLeavesNothing)
{
    const auto cancel = [](double) { return false; };
    EXPECT_THROW(static_cast<void>(trace_reference(geometry_, receivers_, {}, cancel)), Cancelled);
    EXPECT_TRUE(files().empty());
}

TEST_F(ReferenceCache, OddNumbersOfRaysAreRefused)
{
    for (const std::uint32_t rays : {0u, 7u, kMostRays + 2})
        EXPECT_THROW(static_cast<void>(trace_reference(geometry_, receivers_, {.rays = rays})),
                     SettingsError);
}

}  // namespace
}  // namespace surfelao
