#pragma once

namespace coppice::twins {

// As the kernels have them, to the last bit: see kernels/lib/exponential.glsl.

// e^-x of x from 0 on, within 2 units in the last place; 0 from 87 on.
float exp_minus(float x);

// 1 - e^-x, of x from 0 on, within 16 units.
float one_minus_exp(float x);

// -ln y of y above 0, up to 1 and not denormal, within 4 units; near 1 as close as y is.
float minus_log(float y);

}  // namespace coppice::twins
