#version 400
// Colours are linear while light is reckoned; the last line makes them what a screen expects (gamma 2).
uniform sampler2D shadows;     // depth towards the sun
uniform sampler2D floors;      // how much furniture keeps light from the floor
uniform sampler2DArray looks;  // the pictures of the materials
uniform mat4 sunwards;         // world to the shadow map, all in 0..1
uniform vec4 sun;              // direction towards the sun; metres that the shadow map is deep
uniform vec4 ground;           // the home's rectangle: x0, y0, 1 / width, 1 / depth
uniform vec3 eye;
uniform bool shadowed;

in vec3 place;
in vec3 facing;
in vec2 spot;
in vec3 daylight;
flat in vec4 colour;
flat in int what;

layout(location = 0) out vec4 seen;
layout(location = 1) out int tagged;

const float CEILING = 2.4;
const int WINDOWS = 3;
// The renderer fills these in:
const int GATES = 3;      // windows towards the sun that a room has at most
const bool SOFT = true;   // whether the shadow's edge is wide enough to be looked at closely
const bool LIES = true;   // whether anything of this lies on the floor
uniform vec4 room[1 + 2 * (WINDOWS + GATES)];  // see scene.vert
uniform bool indoors;
const int LAMP = 9, WINDOW = 8, METAL = 6, GLASS = 7, TILES = 4, WALL_TILES = 13, PLANKS = 3, SKIN = 10;

float near(float metres) {
    float open = 1.0 + 5.0 * max(metres, 0.0);
    return 1.0 / (open * open);
}

// How much of the sun's light comes here, 0 to 1, past furniture that is in the same room.
float lit(vec3 normal, float leaves) {
    vec4 there = sunwards * vec4(place + normal * 0.03, 1.0);
    vec2 size = vec2(textureSize(shadows, 0));
    vec2 texel = there.xy * size - 0.5;
    vec2 base = floor(texel), part = texel - base;
    float low = there.z - leaves / sun.w, high = there.z - 0.0012;
    if (!SOFT) {
        vec4 depth = textureGather(shadows, (base + 1.0) / size);
        vec4 free = vec4(greaterThan(depth, vec4(high))) + vec4(lessThan(depth, vec4(low)));
        vec2 rest = 1.0 - part;
        return dot(min(free, 1.0), vec4(rest.x * part.y, part.x * part.y, part.x * rest.y, rest.x * rest.y));
    }
    float total = 0.0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            vec2 corner = (base + vec2(i * 2, j * 2)) / size;
            vec4 depth = textureGather(shadows, corner);
            vec4 free = vec4(greaterThan(depth, vec4(high))) + vec4(lessThan(depth, vec4(low)));
            vec2 x = i == 0 ? vec2(1.0 - part.x, 1.0) : vec2(1.0, part.x);
            vec2 y = j == 0 ? vec2(1.0 - part.y, 1.0) : vec2(1.0, part.y);
            total += dot(min(free, 1.0), vec4(x.x * y.y, x.y * y.y, x.y * y.x, x.x * y.x));
        }
    return total / 9.0;
}

// How far inside a window's opening a point on a wall is: 0 outside, 1 well inside.
float through(vec3 gate) {
    float inside = 0.0;
    if (gate.z > CEILING - 0.01) return inside;
    for (int i = 0; i < GATES; i++) {
        vec4 upright = room[2 + 2 * (WINDOWS + i)];
        if (upright.w <= 0.0) break;
        vec4 opening = room[1 + 2 * (WINDOWS + i)];
        vec2 where = opening.x < 0.5 ? gate.xy : gate.yx;
        vec4 edges = vec4(where.x - opening.z, opening.w - where.x, gate.z - upright.x, upright.y - gate.z);
        vec4 within = clamp(edges / 0.05, 0.0, 1.0);
        inside = max(inside, abs(where.y - opening.y) < 0.25 ? within.x * within.y * within.z * within.w : 0.0);
    }
    return inside;
}

void main() {
    tagged = what;
    vec3 normal = normalize(facing);
    vec3 towards = normalize(eye - place);
    if (dot(normal, towards) < 0.0 && !gl_FrontFacing) normal = -normal;
    int material = int(colour.a + 0.5);
    vec3 look = texture(looks, vec3(spot, float(material))).rgb;
    if (material == WINDOW) {
        seen = vec4(look, 1.0);
        return;
    }
    vec3 own = colour.rgb * look * look * 4.0;

    float shade = 1.0, leaves = 50.0;
    float falls = max(dot(normal, sun.xyz), 0.0);
    if (indoors) {
        vec4 walls = room[0];
        // Corners are darker: each wall, the floor and the ceiling take light from what is near and faces them.
        shade -= 0.26 * near(place.z) * (1.0 - normal.z);
        shade -= 0.16 * near(CEILING - place.z) * (1.0 + normal.z);
        shade -= 0.20 * near(place.x - walls.x) * (1.0 - normal.x);
        shade -= 0.20 * near(walls.z - place.x) * (1.0 + normal.x);
        shade -= 0.20 * near(place.y - walls.y) * (1.0 - normal.y);
        shade -= 0.20 * near(walls.w - place.y) * (1.0 + normal.y);
        shade = max(shade, 0.35);
        if (LIES && place.z < 0.02 && normal.z > 0.9)
            shade *= 1.0 - 0.55 * texture(floors, (place.xy - ground.xy) * ground.zw).r;
        // Where the way to the sun leaves the room: through a wall, or at last the ceiling.
        vec2 far = vec2(sun.x > 0.0 ? walls.z : walls.x, sun.y > 0.0 ? walls.w : walls.y);
        vec2 reach = (far - place.xy) / sun.xy;
        leaves = max(min(min(reach.x, reach.y), (CEILING - place.z) / sun.z), 0.0);
    }
    if (shadowed && falls > 0.0) falls *= lit(normal, leaves);
    float inside = falls > 0.0 && indoors ? through(place + sun.xyz * leaves) : 0.0;
    float up = 0.5 + 0.5 * normal.z;
    vec3 sky = mix(vec3(0.50, 0.475, 0.45), vec3(0.56, 0.57, 0.585), up);
    // A little difference between walls that meet, where no light falls on either.
    sky *= 1.0 + 0.05 * normal.x - 0.03 * normal.y;
    vec3 light = (daylight + sky) * shade + vec3(0.46, 0.44, 0.40) * falls + vec3(1.0, 0.90, 0.72) * (1.1 * falls * inside);
    if (material == METAL || material == GLASS || material == TILES || material == WALL_TILES) {
        vec3 back = reflect(-towards, normal);
        float edge = 1.0 - max(dot(normal, towards), 0.0);
        float shine = (material == METAL ? 0.30 : 0.05) + 0.35 * edge * edge * edge;
        vec3 around = mix(vec3(0.30, 0.27, 0.25), vec3(0.95, 0.97, 1.0), smoothstep(-0.35, 0.75, back.z));
        own = mix(own, around, shine * (material == METAL || material == GLASS ? 1.0 : 0.5));
    }
    vec3 sent = own * light;
    if (material == LAMP) sent = own * (0.75 + 0.4 * light);
    // Bright light is bent towards white, never beyond it.
    vec3 over = max(sent - 0.55, 0.0) / 0.45;
    sent = min(sent, 0.55) + 0.45 * over / (1.0 + over);
    seen = vec4(sqrt(sent), 1.0);
}
