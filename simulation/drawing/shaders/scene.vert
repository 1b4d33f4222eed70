#version 400
// Every vertex is in the world already: see scenery.VERTEX. Daylight from the windows is reckoned here; it changes
// slowly, and floors and walls are made of small pieces.
uniform mat4 lens;
uniform bool indoors;     // whether it is in a room

in vec3 at;
in vec4 normal;
in vec4 paint;
in vec2 uv;
in int tag;

out vec3 place;
out vec3 facing;
out vec2 spot;
out vec3 daylight;
flat out vec4 colour;
flat out int what;

const int WINDOWS = 3;
const int GATES = 3;      // see scene.frag
// The room: its rectangle, then for each window (axis, at, start, end) and (low, high, inward, area), and again for
// those towards the sun.
uniform vec4 room[1 + 2 * (WINDOWS + GATES)];

void main() {
    gl_Position = lens * vec4(at, 1.0);
    place = at;
    facing = normalize(normal.xyz);
    spot = uv;
    colour = vec4(paint.rgb * paint.rgb, paint.a * 255.0);
    what = tag;
    daylight = vec3(0.0);
    for (int i = 0; i < WINDOWS && indoors; i++) {
        vec4 opening = room[1 + 2 * i];
        vec4 upright = room[2 + 2 * i];
        if (upright.w <= 0.0) break;
        bool along = opening.x < 0.5;
        float middle = 0.5 * (opening.z + opening.w), height = 0.5 * (upright.x + upright.y);
        vec3 pane = along ? vec3(middle, opening.y, height) : vec3(opening.y, middle, height);
        vec3 inward = along ? vec3(0.0, upright.z, 0.0) : vec3(upright.z, 0.0, 0.0);
        vec3 way = pane - at;
        float closer = inversesqrt(dot(way, way) + 0.35);
        float falls = max(dot(facing, way) * closer * 0.75 + 0.25, 0.0) * max(-dot(inward, way) * closer, 0.0);
        daylight += vec3(0.86, 0.93, 1.0) * (0.85 * falls * upright.w * min(closer * closer, 1.2));
    }
}
