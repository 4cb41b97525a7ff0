"""screen_views.py: views of docs/figures/screen.json: the screen-space passes (docs/screen_space.md)."""

from figure_views import fixed, table, view


def passes(figures, **keys):
    return [row for row in figures["screen"]["rows"]
            if all(row[key] == value for key, value in keys.items())]


def time_of(figures, row):
    """By the device's clock; on software the processor's, which others on the machine disturb less."""
    return row["cpu_ms"] if figures["screen"]["software"] else row["ms"]


@view
def screen_times(figures):
    """Milliseconds of each pass alone: a framed ball, and a room that fills the picture"""
    engines = list(dict.fromkeys(row["engine"] for row in figures["screen"]["rows"]))
    places = [(scene, samples) for scene in ("ball", "room") for samples in (8, 16, 24)]
    rows = [[engine, *(fixed(time_of(figures, passes(figures, scene=scene, engine=engine,
                                                     samples=samples)[0]), 0)
                       for scene, samples in places)]
            for engine in engines]
    return table(["pass", *(f"{scene}, {samples}" for scene, samples in places)], rows)


@view
def screen_slowest(figures, scene):
    """screen_slowest SCENE: the slowest pass of 24 samples there"""
    return fixed(max(time_of(figures, row) for row in passes(figures, scene=scene, samples=24)), 0)


@view
def screen_covered(figures, scene):
    """screen_covered SCENE: per cent of the pixels that see something"""
    return fixed(100 * passes(figures, scene=scene)[0]["covered"], 0)


@view
def screen_device(figures):
    """The device of these figures, and its clock"""
    screen = figures["screen"]
    if screen["software"]:
        return f"software OpenGL, {screen['renderer']}, processor time over {screen['threads']} threads"
    return f"{screen['renderer']}, {screen['clock']}"
