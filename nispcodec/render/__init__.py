"""Pictures: a model sphere-traced, a mesh hit by rays, both shaded by the same code.

    from nispcodec.render.camera import turntable, view
    from nispcodec.render.views import on_white, render_views, scene_of

    ours = render_views(model, turntable(8), 512)           model: a NispModel
    theirs = render_views(mesh, turntable(8), 512)          mesh: a TexturedMesh, in its own frame
    decoded = render_views(other, turntable(8), 512, frame=model.document.frame)

Each picture is (size, size, 4) float32 in [0, 1]: sRGB-encoded RGB and straight alpha, top row
first; `on_white` makes it (size, size, 3) for `nispcodec.metrics.pictures.compare_pictures`. A
scene (`scene_of`) can be made once and passed instead of the model or mesh.
"""
