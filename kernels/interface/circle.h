#ifndef COPPICE_INTERFACE_CIRCLE_H
#define COPPICE_INTERFACE_CIRCLE_H
#include "types.h"
INTERFACE_BEGIN

// (cos, sin) of x quarter turns, x from -1/2 to 1/2: polynomials in y = x * x, the first coefficient of the
// lowest power; sin is x times its own. To 1.5e-7, and by add and multiply alone.
const float TURN_COS_0 = 1.0, TURN_COS_1 = -1.23370055, TURN_COS_2 = 0.253669508, TURN_COS_3 = -0.0208634808,
            TURN_COS_4 = 0.000919260274;
const float TURN_SIN_0 = 1.57079633, TURN_SIN_1 = -0.645964098, TURN_SIN_2 = 0.0796926262,
            TURN_SIN_3 = -0.00468175414, TURN_SIN_4 = 0.000160441185;

INTERFACE_END
#endif
