#include "bake/sparse_texels.h"

#include "bake/vertex_fit.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class Lattice {
public:
    Lattice(std::span<const Texel> texels, std::span<const Receiver> receivers, std::uint32_t width)
        : texels_(texels),
          receivers_(receivers),
          width_(width),
          first_row_(texels.front().y),
          numbers_((texels.back().y - texels.front().y + 1) * std::size_t{width}, kNone)
    {
        for_all(texels.size(), [&](std::size_t i) {
            if (is_single(i))
                numbers_[place_of(texels[i].x, texels[i].y)] = static_cast<std::uint32_t>(i);
        });
    }

    /// Of one sheet, asked at its centre.
    [[nodiscard]] bool is_single(std::size_t i) const
    {
        const auto is_same = [&](const Texel& other) {
            return other.x == texels_[i].x && other.y == texels_[i].y;
        };
        return texels_[i].share == 1.0f && !(i > 0 && is_same(texels_[i - 1])) &&
               !(i + 1 < texels_.size() && is_same(texels_[i + 1]));
    }

    /// Asked first.
    [[nodiscard]] bool is_first(std::size_t i) const
    {
        return (texels_[i].x % 2 == 0 && texels_[i].y % 2 == 0) || !is_single(i);
    }

    /// The mean of those around a texel that is not asked first; nothing where it has to be asked
    /// itself.
    [[nodiscard]] std::optional<Occlusion> mean_around(std::size_t i,
                                                       std::span<const Occlusion> answers) const
    {
        const std::int64_t right = texels_[i].x % 2, down = texels_[i].y % 2;
        // opposite ones one behind the other
        const std::uint32_t around[] = {at(i, -right, -down), at(i, right, down),
                                        at(i, right, -down), at(i, -right, down)};
        const std::span<const std::uint32_t> taken(around, right != 0 && down != 0 ? 4 : 2);
        if (std::ranges::find(taken, kNone) != taken.end())
            return {};
        float occlusion = 0.0f, least = 1.0f, most = 0.0f;
        glm::vec3 position(0.0f), normal(0.0f), bent(0.0f);
        const float share = 1.0f / static_cast<float>(taken.size());
        for (const std::uint32_t other : taken) {
            const Occlusion& answer = answers[other];
            least = std::min(least, answer.occlusion);
            most = std::max(most, answer.occlusion);
            occlusion += share * answer.occlusion;
            position += share * receivers_[other].position;
            normal += share * receivers_[other].normal;
            bent += share * (1.0f - answer.occlusion) * answer.bent_normal;
        }
        const Receiver& amid = receivers_[i];
        const float reach =
            glm::distance(receivers_[taken[0]].position, receivers_[taken[1]].position);
        if (most - least > kSparseStep ||
            glm::distance(position, amid.position) > kSparseReach * reach ||
            glm::dot(amid.normal, normal) < kSparseTurn * glm::length(normal))
            return {};
        const float open = glm::length(bent);
        return Occlusion{occlusion, open > kLeastBent ? bent / open : amid.normal};
    }

private:
    [[nodiscard]] std::size_t place_of(std::size_t x, std::size_t y) const
    {
        return (y - first_row_) * width_ + x;
    }

    /// The single texel so many columns and rows beside another; or kNone.
    [[nodiscard]] std::uint32_t at(std::size_t i, std::int64_t right, std::int64_t down) const
    {
        const std::int64_t x = texels_[i].x + right, y = texels_[i].y + down;
        if (x < 0 || x >= std::int64_t{width_} || y < std::int64_t{first_row_} ||
            y > std::int64_t{texels_.back().y})
            return kNone;
        return numbers_[place_of(static_cast<std::size_t>(x), static_cast<std::size_t>(y))];
    }

    std::span<const Texel> texels_;
    std::span<const Receiver> receivers_;
    std::uint32_t width_;
    std::uint32_t first_row_;
    std::vector<std::uint32_t> numbers_;  ///< of single texels, by place
};

}  // namespace

std::vector<Occlusion> sparse_answers(std::span<const Texel> texels,
                                      std::span<const Receiver> receivers, std::uint32_t width,
                                      const AskReceivers& ask)
{
    SURFELAO_CHECK(texels.size() == receivers.size());
    if (texels.empty())
        return {};
    const Lattice lattice(texels, receivers, width);
    std::vector<Occlusion> answers(texels.size());
    std::vector<std::uint8_t> is_asked(texels.size(), 0);
    const auto ask_some = [&](std::uint8_t round) {
        std::vector<std::size_t> numbers;
        std::vector<Receiver> asked;
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (is_asked[i] != round)
                continue;
            numbers.push_back(i);
            asked.push_back(receivers[i]);
        }
        if (asked.empty())
            return;
        const std::vector<Occlusion> found = ask(asked);
        for (std::size_t k = 0; k < numbers.size(); ++k)
            answers[numbers[k]] = found[k];
    };
    for_all(texels.size(), [&](std::size_t i) { is_asked[i] = lattice.is_first(i) ? 1 : 0; });
    ask_some(1);
    for_all(texels.size(), [&](std::size_t i) {
        if (is_asked[i] != 0)
            return;
        const std::optional<Occlusion> mean = lattice.mean_around(i, answers);
        if (mean)
            answers[i] = *mean;
        else
            is_asked[i] = 2;
    });
    ask_some(2);
    return answers;
}

}  // namespace surfelao
