// Colours that tell numbers apart: bytes of a hash, PCG's output function (M. E. O'Neill, "PCG: A Family of Simple Fast
// Space-Efficient Statistically Good Algorithms for Random Number Generation", 2014). No channel is below a quarter;
// squared, so that the colours that are seen are spread evenly.
vec3 colour_of_id(uint id) {
  uint state = id * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  word = (word >> 22) ^ word;
  vec3 bytes = vec3(float(word & 255u), float(word >> 8 & 255u), float(word >> 16 & 255u));
  precise vec3 seen = bytes * 0.0029296875 + 0.25;
  precise vec3 colour = seen * seen;
  return colour;
}
