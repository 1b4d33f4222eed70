#version 400
uniform mat4 lens;
in vec3 at;
void main() { gl_Position = lens * vec4(at, 1.0); }
