#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/view.h"

namespace coppice {

// A camera that a hand moves: around a point, or as one flies. It stays upright: +y of the scene is up.
class CameraControl {
 public:
  // From a view of the scene; `size` is about its greatest extent.
  CameraControl(const View& view, double size);

  // By parts of the picture's height: around the target; away from it, both of them; or towards it.
  void orbit(double right, double down);
  void pan(double right, double down);
  void zoom(double steps);

  // As one flies: where the eye looks, and where it goes, in parts of the scene's size.
  void look(double right, double down);
  void fly(double forward, double right, double up);

  double fov() const { return fov_; }

  // The numbers of --camera (eye, target, field of view), in the coordinates of the scene's file.
  std::vector<double> numbers(const Scene& scene) const;

 private:
  glm::dvec3 direction() const;
  void turn(double right, double down);

  glm::dvec3 target_;
  double distance_, yaw_, pitch_;  // of the eye from the target; radians
  double size_, fov_;
};

// The numbers of --camera for a view, with what is up in the picture where that is not the scene's +y.
std::vector<double> camera_numbers(const Scene& scene, const View& view);

// As --camera takes them, each such that it is read back exactly.
std::string camera_text(const std::vector<double>& numbers);

}  // namespace coppice
