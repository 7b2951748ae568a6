// Moller and Trumbore 1997, without a threshold: the inside tests compare with the determinant itself, so they hold at
// every scale, and only a determinant of zero (edge-on or degenerate) misses.

vec3 exact_cross(vec3 a, vec3 b) {
  precise vec3 product = a.yzx * b.zxy - a.zxy * b.yzx;
  return product;
}

float exact_dot(vec3 a, vec3 b) {
  precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// Of equally close triangles the smallest index wins, whatever the order of the tests.
void intersect_triangle(Ray ray, Triangle triangle, uint index, inout Hit hit) {
  precise vec3 edge_b = triangle.b - triangle.a;
  precise vec3 edge_c = triangle.c - triangle.a;
  vec3 p = exact_cross(ray.direction, edge_c);
  float determinant = exact_dot(edge_b, p);
  float side = determinant < 0.0 ? -1.0 : 1.0;
  precise vec3 from_a = ray.origin - triangle.a;
  float u = exact_dot(from_a, p) * side;
  vec3 q = exact_cross(from_a, edge_b);
  float v = exact_dot(ray.direction, q) * side;
  precise float u_plus_v = u + v;
  if (!(u >= 0.0 && v >= 0.0 && u_plus_v <= determinant * side) || determinant == 0.0) return;
  float t = exact_dot(edge_c, q) / determinant;
  if (!(t >= ray.t_min && t <= hit.t) || (t == hit.t && index >= hit.triangle)) return;
  hit = Hit(t, index, u / (determinant * side), v / (determinant * side));
}

// A ray with a NaN or without direction hits nothing; it is told apart before it visits the whole tree.
bool can_hit(Ray ray) {
  return !(any(isnan(ray.origin)) || any(isnan(ray.direction))) && ray.t_min <= ray.t_max &&
         ray.direction != vec3(0.0);
}
