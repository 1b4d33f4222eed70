#version 400
// Every vertex is in the world already: see scenery.VERTEX.
uniform mat4 lens;
uniform sampler2D rooms;

in vec3 at;
in vec4 normal;
in vec4 paint;
in vec2 uv;
in ivec2 tag;

out vec3 place;
out vec3 facing;
out vec2 spot;
flat out vec4 colour;
flat out int what;
flat out int room;

void main() {
    gl_Position = lens * vec4(at, 1.0);
    place = at;
    facing = normal.xyz;
    spot = uv;
    colour = vec4(paint.rgb * paint.rgb, paint.a * 255.0);
    what = tag.x;
    room = tag.y;
}
