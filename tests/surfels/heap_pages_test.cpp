#include "surfels/heap_pages.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <vector>

namespace surfelao {
namespace {

long faults()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

/// Of an array of 16 MiB, which is freed again: 4,096 of the system's small pages.
long faults_of_an_array()
{
    const long before = faults();
    const std::vector<char> array(std::size_t{16} << 20, 1);
    EXPECT_EQ(std::ranges::count(array, 1), static_cast<std::ptrdiff_t>(array.size()));
    return faults() - before;
}

TEST(HeapPages, AreThereForTheNextArray)
{
    keep_heap_pages();
    faults_of_an_array();
    EXPECT_LT(faults_of_an_array(), 100);

    return_heap_pages();
    faults_of_an_array();
    EXPECT_GT(faults_of_an_array(), 2'000);
}

}  // namespace
}  // namespace surfelao
