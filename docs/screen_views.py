"""screen_views.py: views of docs/figures/screen.json: the screen-space passes (docs/screen_space.md)."""

from figure_views import fixed, table, view


def passes(figures, **keys):
    return [row for row in figures["screen"]["rows"]
            if all(row[key] == value for key, value in keys.items())]


@view
def screen_times(figures):
    """Milliseconds of each pass alone: a framed ball, and a room that fills the picture"""
    engines = list(dict.fromkeys(row["engine"] for row in figures["screen"]["rows"]))
    places = (("ball", 0.1), ("room", 0.1), ("room", 0.3))
    rows = [[engine, *(fixed(passes(figures, scene=scene, radius=radius, engine=engine,
                                    samples=samples)[0]["ms"], 0)
                       for scene, radius in places for samples in (8, 16, 24))]
            for engine in engines]
    heads = [f"{scene}, R = {radius:g}: {samples}" for scene, radius in places
             for samples in (8, 16, 24)]
    return table(["pass", *heads], rows)


@view
def screen_slowest(figures, scene):
    """screen_slowest SCENE: the slowest pass of 24 samples there, R a tenth"""
    return fixed(max(row["ms"] for row in passes(figures, scene=scene, radius=0.1, samples=24)), 0)


@view
def screen_covered(figures, scene):
    """screen_covered SCENE: per cent of the pixels that see something"""
    return fixed(100 * passes(figures, scene=scene)[0]["covered"], 0)


@view
def screen_device(figures):
    """The device of these figures, and its clock"""
    screen = figures["screen"]
    kind = "software OpenGL, " if screen["software"] else ""
    return f"{kind}{screen['renderer']}, {screen['clock']}"
