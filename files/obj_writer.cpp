#include "files/maker_mark.h"
#include "files/obj_file.h"
#include "files/obj_io.h"
#include "files/sidecars.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <array>

namespace surfelao {
namespace {

/// What stands behind the coordinates of a vertex line: the colour's words, if there are any.
struct LineColor {
    std::array<std::string_view, 4> words;
    std::size_t count = 0;

    [[nodiscard]] std::span<const std::string_view> span() const { return {words.data(), count}; }
};

/// Reads on to the end of a vertex line, from behind z on: one number there is a weight.
LineColor read_color(TextCursor& cursor)
{
    LineColor color;
    while (!cursor.at_line_end()) {
        const std::string_view word = cursor.word();
        if (color.count < color.words.size())
            color.words[color.count++] = word;
    }
    if (color.count < 3)
        color.count = 0;
    return color;
}

void skip_coordinates(TextCursor& cursor)
{
    for (int axis = 0; axis < 3; ++axis)
        cursor.word();
}

void append_color(std::string& text, const ColorPlan& plan, std::string_view own,
                  std::size_t vertex, const Occlusion& occlusion)
{
    if (plan.what == VertexColors::keep) {
        text.append(own.empty() ? "" : " ").append(own);
        return;
    }
    const glm::vec3 numbers = plan.numbers(vertex, occlusion);
    for (int channel = 0; channel < 3; ++channel)
        append_fixed(text += ' ', numbers[channel], 6);
    if (std::ranges::count(own, ' ') == 3)  // alpha
        text.append(own.substr(own.rfind(' ')));
}

void append_mark_line(std::string& text, std::string_view mark, std::string_view line_end)
{
    if (!mark.empty())
        text.append("# ").append(mark).append(line_end);
}

/// The source's text with new colours and names of files; copies what lies between.
class TextWriter {
public:
    TextWriter(const ObjSource& source, const ObjSource::Own& own, const ColorPlan& plan,
               std::filesystem::path folder)
        : source_(source), own_(own), plan_(plan), folder_(std::move(folder))
    {
    }

    std::string write(std::span<const Occlusion> occlusion, std::string_view mark)
    {
        const std::string_view old = own_.text;
        text_.reserve(old.size() + mark.size() + occlusion.size() * 28);
        if (old.starts_with(kByteOrderMark))
            copy_to(kByteOrderMark.size());
        append_mark_line(text_, mark, line_end_of(old));
        copied_ += obj_mark(old.substr(copied_)).line.size();
        std::size_t vertex = 0;
        TextCursor cursor("", old, kObjRules);
        while (cursor.next_line()) {
            const std::string_view statement = cursor.word();
            if (statement == "v") {
                replace_color(cursor, vertex, occlusion[vertex]);
                ++vertex;
            } else if (statement == "mtllib") {
                replace_names(cursor);
            }
        }
        copy_to(old.size());
        if (plan_.replaces())
            own_.colors.append_comments(text_);
        return std::move(text_);
    }

    std::vector<std::string> missing;  ///< names of files that are not there

private:
    void copy_to(std::size_t end)
    {
        text_.append(own_.text.substr(copied_, end - copied_));
        copied_ = end;
    }

    void replace_color(TextCursor& cursor, std::size_t vertex, const Occlusion& occlusion)
    {
        skip_coordinates(cursor);
        copy_to(cursor.offset());
        append_color(text_, plan_, plan_.has_own() ? own_.colors[vertex] : "", vertex, occlusion);
        read_color(cursor);
        copied_ = cursor.offset();
        if (copied_ < own_.text.size() && own_.text[copied_] == kObjRules.comment)
            text_ += ' ';
    }

    void replace_names(TextCursor& cursor)
    {
        const std::size_t begin = cursor.offset();
        while (!cursor.at_line_end())
            cursor.word();
        copy_to(begin);
        const std::string_view names = own_.text.substr(begin, cursor.offset() - begin);
        text_ += names_from(folder_, source_.folder, names, missing);
        copied_ = cursor.offset();
    }

    const ObjSource& source_;
    const ObjSource::Own& own_;
    const ColorPlan& plan_;
    std::filesystem::path folder_;
    std::string text_;
    std::size_t copied_ = 0;  ///< bytes of the old text
};

std::string new_obj(const Scene& scene, std::span<const Occlusion> occlusion, const ColorPlan& plan,
                    std::string_view mark)
{
    ColorWords own;
    for (const glm::vec4& color : plan.own)
        own.add(color, ColorWords::Form::decimals);
    std::string text;
    append_mark_line(text, mark, "\n");
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        text += 'v';
        for (int axis = 0; axis < 3; ++axis)
            append_shortest(text += ' ', scene.positions[v][axis]);
        if (plan.writes())
            append_color(text, plan, plan.has_own() ? own[v] : "", v, occlusion[v]);
        text += '\n';
    }
    for_each_face(scene, [&](std::span<const std::uint32_t> corners) {
        text += 'f';
        for (const std::uint32_t corner : corners)
            append_integer(text += ' ', std::int64_t{corner} + 1);
        text += '\n';
    });
    if (plan.replaces())
        own.append_comments(text);
    return text;
}

}  // namespace

ObjSource::Own ObjSource::own() const
{
    Own own{text, {}};
    if (!has_colors)
        return own;
    own.text = own.colors.take_comments(text, vertex_count);
    std::string_view marked = text;
    marked.remove_prefix(marked.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    if (own.colors.size() > 0 || colors_are_baked(obj_mark(marked).mark))
        return own;
    TextCursor cursor("", text, kObjRules);
    while (cursor.next_line()) {
        if (cursor.word() != "v")
            continue;
        skip_coordinates(cursor);
        own.colors.add(read_color(cursor).span());
    }
    return own;
}

WrittenFile obj_contents(const std::filesystem::path& path, const Scene& scene,
                         std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    WrittenFile written;
    const auto plan_of = [&](std::vector<glm::vec4> own) {
        return plan_colors(options, std::move(own), OcclusionPlace::none, written.notes);
    };
    const auto* source = dynamic_cast<const ObjSource*>(scene.asset.get());
    if (!source) {
        const ColorPlan plan = plan_of(own_colors_of(scene));
        written.contents = new_obj(scene, occlusion, plan, options.mark);
        return written;
    }
    const ObjSource::Own own = source->own();
    const ColorPlan plan = plan_of(own.colors.linear());
    TextWriter writer(*source, own, plan, path.parent_path());
    written.contents = writer.write(occlusion, options.mark);
    note_missing(writer.missing, written.notes);
    return written;
}

}  // namespace surfelao
