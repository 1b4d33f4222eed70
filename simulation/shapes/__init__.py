"""What things look like, as data: boxes, cylinders and balls put together by one recipe per thing.

`kit` and `rotations` are the tools of all recipes; the other files hold the recipes, by the kind of thing.
"""
