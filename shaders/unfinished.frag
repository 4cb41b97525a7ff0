#version 330 core
// unfinished.frag: lets a fragment through where a computation has not come to its end.
//
// Vertices   fullscreen.vert
// Drawn by   gpu/receiver_grid.cpp, for the question whether any fragment comes through
// Reads      u_at   usampler2D: how far each pixel is
//            u_end  a pixel that is at or beyond this is done
uniform usampler2D u_at;
uniform uint u_end;

void main()
{
    if (texelFetch(u_at, ivec2(gl_FragCoord.xy), 0).x >= u_end)
        discard;
}
