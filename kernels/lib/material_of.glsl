// The material of a hit: of its triangle or, where materials are those of hits (texture_hits), of its ray.
// Needs `args` with materials and material_index, which is null there.
SurfaceMaterial material_of(uint ray, uint triangle) {
  bool of_hits = uint64_t(args.material_index) == 0ul;
  return args.materials.at[of_hits ? ray : args.material_index.at[triangle]];
}
