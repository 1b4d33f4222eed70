"""Pictures of a home with OpenGL: what there is to draw as triangles, and a renderer that draws them.

`scenery` knows nothing of OpenGL: it turns homes, things, people and robots into triangles in the world. `renderer`
draws those, into colours, depth and numbers of what is seen.
"""
