# Shows each glTF of jobs.json as Godot imports it, under ambient light alone.
extends Spatial

func vector(array):
    return Vector3(array[0], array[1], array[2])

func _ready():
    var file = File.new()
    file.open("res://jobs.json", File.READ)
    var jobs = JSON.parse(file.get_as_text()).result
    var light = WorldEnvironment.new()
    light.environment = Environment.new()
    light.environment.background_mode = Environment.BG_COLOR
    light.environment.ambient_light_color = Color(1, 1, 1)
    light.environment.ambient_light_sky_contribution = 0
    add_child(light)
    get_viewport().transparent_bg = true
    for job in jobs:
        var model = load("res://" + job.file).instance()
        add_child(model)
        var view = job.camera
        var camera = Camera.new()
        var back = vector(view.back)
        camera.set_orthogonal(2 * view.half, 0.01, 8 * view.half)
        camera.transform = Transform(vector(view.right), vector(view.up), back,
                vector(view.center) + back * 4 * view.half)
        add_child(camera)
        camera.current = true
        for frame in range(3):
            yield(get_tree(), "idle_frame")
        yield(VisualServer, "frame_post_draw")
        var picture = get_viewport().get_texture().get_data()
        picture.flip_y()
        picture.save_png(job.picture)
        model.queue_free()
        camera.queue_free()
    get_tree().quit()
