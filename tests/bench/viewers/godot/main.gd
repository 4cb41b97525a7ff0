# Shows each glTF of jobs.json under white ambient light alone, as Godot imports it and, where a job
# says so, with one switch of its materials turned on.
extends Spatial

const SWITCHES = {
    "albedo": SpatialMaterial.FLAG_ALBEDO_FROM_VERTEX_COLOR,  # Vertex Color > Use As Albedo
    "uv2": SpatialMaterial.FLAG_AO_ON_UV2,  # Ambient Occlusion > On UV2
}

func vector(array):
    return Vector3(array[0], array[1], array[2])

func set_flag(node, flag):
    if node is MeshInstance:
        for surface in range(node.mesh.get_surface_count()):
            node.mesh.surface_get_material(surface).set_flag(flag, true)
    for child in node.get_children():
        set_flag(child, flag)

func _ready():
    var file = File.new()
    file.open("res://jobs.json", File.READ)
    var jobs = JSON.parse(file.get_as_text()).result
    var light = WorldEnvironment.new()
    light.environment = Environment.new()
    light.environment.background_mode = Environment.BG_COLOR
    light.environment.background_color = Color(0.43, 0.43, 0.43)
    light.environment.ambient_light_color = Color(1, 1, 1)
    light.environment.ambient_light_sky_contribution = 0
    add_child(light)
    for job in jobs:
        var model = load("res://" + job.file).instance()
        if job.show in SWITCHES:
            set_flag(model, SWITCHES[job.show])
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
