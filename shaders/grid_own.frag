#version 330 core

// grid_own.frag: what surfaces leave of their light by themselves, before their grids are read.
//
// Vertices   fullscreen.vert
// Reads      u_own  RG32F: that share, and the surface's number
// Writes     out_visibility

uniform sampler2D u_own;

out float out_visibility;

void main() { out_visibility = texelFetch(u_own, ivec2(gl_FragCoord.xy), 0).r; }
