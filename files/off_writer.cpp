#include "files/maker_mark.h"
#include "files/off_file.h"
#include "files/off_io.h"
#include "surfels/number_text.h"

#include <algorithm>

namespace surfelao {
namespace {

/// What stands behind the coordinates and the normal of a vertex.
struct VertexRest {
    bool lacks_normal = false;                     ///< although the others have one
    std::vector<std::string_view> color, texture;  ///< 0 0 where it lacks one
};

/// Calls visit(begin, end, rest) for each vertex: the bytes of its rest in the text.
template <class Visit>
void for_each_vertex(const OffHeader& header, std::string_view text, const Visit& visit)
{
    TextCursor cursor("", text.substr(header.end), kOffRules, 2);
    VertexRest rest;
    std::vector<std::string_view> words;
    for (std::uint64_t vertex = 0; vertex < header.vertices; ++vertex) {
        cursor.next_line();
        for (int axis = 0; axis < 3; ++axis)
            cursor.word();
        std::size_t begin = cursor.offset();
        rest.lacks_normal = false;
        for (int axis = 0; axis < 3 && header.has_normals; ++axis)
            rest.lacks_normal = cursor.word().empty();
        if (!rest.lacks_normal)
            begin = cursor.offset();
        words.clear();
        while (!cursor.at_line_end())
            words.push_back(cursor.word());
        const int colors = header.color_words(static_cast<int>(words.size()));
        rest.color.assign(words.begin(), words.begin() + colors);
        rest.texture.clear();
        if (header.has_textures && words.size() >= 2)
            rest.texture.assign(words.end() - 2, words.end());
        else if (header.has_textures)
            rest.texture = {"0", "0"};
        visit(header.end + begin, header.end + cursor.offset(), rest);
    }
}

/// own: the words of its own colour, if it has one.
void append_vertex_color(std::string& text, const ColorPlan& plan, std::string_view own,
                         std::size_t vertex, const Occlusion& occlusion)
{
    if (plan.what == VertexColors::keep) {
        text.append(own.empty() ? "" : " ").append(own);
        return;
    }
    const glm::vec3 numbers = plan.numbers(vertex, occlusion);
    for (int channel = 0; channel < 3; ++channel)
        append_integer(text += ' ', byte_of(numbers[channel]));
    append_integer(text += ' ', byte_of(plan.has_own() ? plan.own[vertex].w : 1.0f));
}

void append_keyword(std::string& text, const OffHeader& header, const ColorPlan& plan)
{
    text.append(header.has_textures ? "ST" : "").append(plan.writes() ? "C" : "");
    text.append(header.has_normals ? "N" : "").append("OFF");
}

void append_mark(std::string& text, std::string_view mark)
{
    if (mark.empty())
        return;
    const std::string end(line_end_of(text));
    if (text.back() != '\n' && text.back() != '\r')
        text += end;
    text.append("# ").append(mark).append(end);
}

/// The source's text with a new keyword and new colours.
std::string with_new_colors(const OffSource& source, const OffSource::Own& own,
                            std::span<const Occlusion> occlusion, const ColorPlan& plan)
{
    const OffHeader& header = source.header;
    const std::string_view old = own.text;
    std::string text;
    text.reserve(old.size() + occlusion.size() * 16);
    std::size_t copied = 0;
    const auto copy_to = [&](std::size_t end) {
        text.append(old.substr(copied, end - copied));
        copied = end;
    };
    if (old.starts_with(kByteOrderMark))
        copy_to(kByteOrderMark.size());
    if (header.keyword.empty()) {
        append_keyword(text, header, plan);
        text.append(line_end_of(old));
    } else {
        copy_to(static_cast<std::size_t>(header.keyword.data() - old.data()));
        append_keyword(text, header, plan);
        text.append(header.is_glued ? " " : "");
        copied += header.keyword.size();
    }
    std::size_t vertex = 0;
    for_each_vertex(header, old, [&](std::size_t begin, std::size_t end, const VertexRest& rest) {
        copy_to(begin);
        text.append(rest.lacks_normal ? " 0 0 0" : "");
        append_vertex_color(text, plan, plan.has_own() ? own.colors[vertex] : "", vertex,
                            occlusion[vertex]);
        for (const std::string_view word : rest.texture)
            text.append(" ").append(word);
        copied = end;
        if (copied < old.size() && old[copied] == kOffRules.comment)
            text += ' ';
        ++vertex;
    });
    copy_to(old.size());
    return text;
}

std::string new_off(const Scene& scene, const ColorWords& own, std::span<const Occlusion> occlusion,
                    const ColorPlan& plan)
{
    std::string text;
    OffHeader header;
    header.has_normals = scene.normals.of_vertices();
    append_keyword(text, header, plan);
    append_integer(text += '\n', static_cast<std::int64_t>(scene.positions.size()));
    append_integer(text += ' ', static_cast<std::int64_t>(face_count(scene)));
    text += " 0\n";
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text.append(axis > 0 ? " " : ""), scene.positions[v][axis]);
        for (int axis = 0; axis < 3 && header.has_normals; ++axis)
            append_shortest(text += ' ', scene.normals.values[v][axis]);
        append_vertex_color(text, plan, plan.has_own() ? own[v] : "", v, occlusion[v]);
        text += '\n';
    }
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        append_integer(text, static_cast<std::int64_t>(corners.size()));
        for (const std::uint32_t corner : corners)
            append_integer(text += ' ', corner);
        text += '\n';
    });
    return text;
}

}  // namespace

OffSource::Own OffSource::own() const
{
    const MarkLine mark = off_mark(text);
    Own own{std::string_view(text).substr(0, text.size() - mark.line.size()), {}};
    if (!header.has_colors) {
        own.colors.deny_comments(own.text, header.vertices);
        return own;
    }
    own.text = own.colors.take_comments(own.text, header.vertices);
    if (own.colors.size() > 0 || colors_are_baked(mark.mark))
        return own;
    for_each_vertex(header, text, [&](std::size_t, std::size_t, const VertexRest& rest) {
        own.colors.add(rest.color);
    });
    return own;
}

WrittenFile off_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                         const WriteOptions& options)
{
    WrittenFile written;
    const auto plan_of = [&](std::vector<glm::vec4> own) {
        return plan_colors(options, std::move(own), OcclusionPlace::none, written.notes);
    };
    std::string& text = written.contents;
    if (const auto* source = dynamic_cast<const OffSource*>(scene.asset.get())) {
        const OffSource::Own own = source->own();
        const ColorPlan plan = plan_of(own.colors.linear());
        text = with_new_colors(*source, own, occlusion, plan);
        if (plan.what != VertexColors::keep)
            own.colors.append_comments(text);
    } else {
        const ColorPlan plan = plan_of(own_colors_of(scene));
        ColorWords own;
        for (const glm::vec4& color : plan.own)
            own.add(color, ColorWords::Form::bytes);
        text = new_off(scene, own, occlusion, plan);
        if (plan.replaces())
            own.append_comments(text);
    }
    append_mark(text, options.mark);
    return written;
}

std::string original_off(const Scene& scene)
{
    WriteOptions keeping;
    keeping.colors = VertexColors::keep;
    return off_contents(scene, std::vector<Occlusion>(scene.positions.size()), keeping).contents;
}

}  // namespace surfelao
