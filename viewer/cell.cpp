#include "viewer/cell.h"

namespace surfelao {

Where where_of(const Cell& cell)
{
    if (cell.from_maps)
        return Where::cube_maps;
    if (cell.grid)
        return Where::grid;
    if (cell.at_pixels)
        return Where::pixels;
    return cell.settings.texels ? Where::texels : Where::vertices;
}

void set_where(Cell& cell, Where where, const WhereSettings& settings)
{
    if (where != where_of(cell))
        cell.screen.reset();
    cell.from_maps = where == Where::cube_maps;
    cell.grid = where == Where::grid ? std::optional(settings.grid) : std::nullopt;
    cell.at_pixels = where == Where::pixels || cell.from_maps || cell.grid;
    cell.settings.texels = where == Where::texels ? std::optional(settings.texels) : std::nullopt;
}

void choose_engine(Cell& cell, Engine engine, Device device, std::map<Engine, float>& qualities)
{
    EngineSettings& settings = cell.settings.engine;
    cell.screen.reset();
    settings.device = device;
    if (engine == settings.engine)
        return;
    qualities[settings.engine] = settings.quality;
    settings.engine = engine;
    settings.quality = qualities.try_emplace(engine, kGood).first->second;
}

bool has_radius(const Cell& cell)
{
    return cell.screen && cell.screen->method == ScreenMethod::vo && cell.screen->rule > 0;
}

ViewOptions options_for(const Cell& cell, ViewOptions options)
{
    if (options.colors == Colors::radius && !has_radius(cell))
        options.colors = Colors::visibility;
    return options;
}

std::string name_of(Where where, bool is_cloud)
{
    switch (where) {
        case Where::vertices:
            return is_cloud ? "points" : "vertices";
        case Where::texels:
            return "texels";
        case Where::pixels:
            return "pixels";
        case Where::cube_maps:
            return "cube maps";
        case Where::grid:
            return "AO grid";
    }
    return {};
}

std::string how_of(const Cell& cell)
{
    if (!cell.screen)
        return name_of(cell.settings.engine);
    return cell.from_maps ? "horizon" : name_of(cell.screen->method);
}

std::string name_of(const EngineChoice& choice)
{
    return name_of(choice.engine) + (choice.device == Device::gpu ? " on GPU" : "");
}

}  // namespace surfelao
