// Products in a fixed order, without contraction.

vec3 exact_cross(vec3 a, vec3 b) {
  precise vec3 product = a.yzx * b.zxy - a.zxy * b.yzx;
  return product;
}

float exact_dot(vec3 a, vec3 b) {
  precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}
