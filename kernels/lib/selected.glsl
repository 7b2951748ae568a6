#ifndef COPPICE_LIB_SELECTED
#define COPPICE_LIB_SELECTED
// Minimum and maximum by selection: min and max cost CPU devices several instructions each, for the sake of NaN. Where
// one of the two is NaN the second is taken.
float lesser(float x, float y) { return x < y ? x : y; }
float greater(float x, float y) { return x > y ? x : y; }
vec2 greater(vec2 x, vec2 y) { return vec2(greater(x.x, y.x), greater(x.y, y.y)); }
vec3 lesser(vec3 x, vec3 y) { return vec3(lesser(x.x, y.x), lesser(x.y, y.y), lesser(x.z, y.z)); }
vec3 greater(vec3 x, vec3 y) { return vec3(greater(x.x, y.x), greater(x.y, y.y), greater(x.z, y.z)); }

#endif
