// One batch: the samples [first_sample, end_sample) of a tile; the path tracer takes them in groups.
layout(push_constant, std430) uniform Batch {
    uint tile_x;
    uint tile_y;
    uint tile_width;
    uint tile_height;
    uint first_sample;
    uint end_sample;
    uint group;
} batch;
