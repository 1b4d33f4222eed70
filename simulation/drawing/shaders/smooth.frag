#version 400
// Edges are smoothed by what lies along them: the short form of FXAA (Timothy Lottes, 2009).
uniform sampler2D picture;
out vec4 seen;

float brightness(vec3 colour) { return dot(colour, vec3(0.299, 0.587, 0.114)); }

void main() {
    vec2 size = vec2(textureSize(picture, 0));
    vec2 here = gl_FragCoord.xy / size;
    vec3 middle = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb;
    ivec2 at = ivec2(gl_FragCoord.xy), low = max(at - 1, 0), high = min(at + 1, textureSize(picture, 0) - 1);
    vec3 a = texelFetch(picture, low, 0).rgb;
    vec3 b = texelFetch(picture, ivec2(high.x, low.y), 0).rgb;
    vec3 c = texelFetch(picture, ivec2(low.x, high.y), 0).rgb;
    vec3 d = texelFetch(picture, high, 0).rgb;
    vec4 corners = vec4(brightness(a), brightness(b), brightness(c), brightness(d));
    float own = brightness(middle);
    float least = min(own, min(min(corners.x, corners.y), min(corners.z, corners.w)));
    float most = max(own, max(max(corners.x, corners.y), max(corners.z, corners.w)));
    seen = vec4(middle, 1.0);
    if (most - least < 0.06) return;
    vec2 along = vec2((corners.z + corners.w) - (corners.x + corners.y), (corners.x + corners.z) - (corners.y + corners.w));
    along.y = -along.y;
    float slack = max(dot(corners, vec4(0.03125)), 0.0078125);
    along = clamp(along / (min(abs(along.x), abs(along.y)) + slack), -6.0, 6.0) / size;
    vec3 near = 0.5 * (texture(picture, here - along / 6.0).rgb + texture(picture, here + along / 6.0).rgb);
    vec3 wide = 0.5 * near + 0.25 * (texture(picture, here - along / 2.0).rgb + texture(picture, here + along / 2.0).rgb);
    float check = brightness(wide);
    seen.rgb = check < least || check > most ? near : wide;
}
