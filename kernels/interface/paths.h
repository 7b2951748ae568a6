// Paths of light: surfaces that reflect and transmit, and the directions in which paths go on.
#ifndef COPPICE_INTERFACE_PATHS_H
#define COPPICE_INTERFACE_PATHS_H
#include "circle.h"
#include "trace.h"
INTERFACE_BEGIN

// What a surface does with light at one point. Values out of their range count as its nearest end.
struct SurfacePoint {
  vec3 normal;         // unit, on the side of the view
  float roughness;     // 0 to 1; alpha of GGX is its square
  vec3 diffuse;        // albedo, 0 to 1
  float ior_ratio;     // index of refraction on the side of the view by that of the other side, 1/16 to 16
  vec3 specular;       // reflectance at normal incidence, 0 to 1; black: nothing is reflected but diffusely
  float transmission;  // 0 to 1: the part of the light that is not reflected which goes through
};

INTERFACE_BUFFER(SurfacePointBuffer, SurfacePoint, 16)

// Which lobe a sampled direction is of.
const uint BSDF_NONE = 0u;  // no direction: the path ends
const uint BSDF_DIFFUSE = 1u;
const uint BSDF_GLOSSY = 2u;
const uint BSDF_MIRROR = 4u;
const uint BSDF_TRANSMISSION = 8u;

// A direction in which a path goes on.
struct BsdfSample {
  vec3 light;   // unit, away from the surface
  float pdf;    // by solid angle; 0: no light source that is sampled could have been met, see lib/bsdf.glsl
  vec3 weight;  // BSDF times cosine by the density, that of the choice of the lobe included; not negative
  uint flags;   // BSDF_
};

// BSDF times cosine towards a light, of the lobes that have a density.
struct BsdfTerms {
  vec3 diffuse;
  float pdf;  // by solid angle, of directions as they are sampled
  vec3 glossy;
  float padding;  // 0
};

const float BSDF_MIRROR_ALPHA = 0.001;                  // below it a mirror
const float BSDF_MIN_COSINE = 9.5367431640625e-07;      // 2^-20: nothing is seen at an angle that is flatter
const float BSDF_LEAST_PICK = 0.125;                    // of a rough lobe before shares become probabilities
const float BSDF_LEAST_SHARES = 9.094947017729282e-13;  // 2^-40: darker surfaces end a path
const float ONE_BY_PI = 0.318309886;

INTERFACE_END
#endif
