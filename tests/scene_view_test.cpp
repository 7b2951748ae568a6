// Where a camera looks: straight down and up, --camera and --up.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "scene/view.h"

namespace coppice {
namespace {

void expect_near(glm::dvec3 a, glm::dvec3 b, double within = 1e-12) {
  EXPECT_LE(glm::length(a - b), within)
      << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

View view_from(glm::vec3 eye, glm::vec3 target) { return view_of({.position = eye, .target = target}); }

TEST(View, IsUprightWhereNothingElseIsSaid) {
  const View view = view_from({0, 0, 5}, {0, 0, 0});
  expect_near(view.forward, {0, 0, -1});
  expect_near(view.right, {1, 0, 0});
  expect_near(view.down, {0, -1, 0});
}

TEST(View, DoesNotFlipWhereItNodsToTheVertical) {
  for (const float side : {1.0f, -1.0f}) {  // down and up
    const View vertical = view_from({0, 5 * side, 0}, {0, 0, 0});
    expect_near(vertical.right, {1, 0, 0});
    expect_near(vertical.down, {0, 0, side});
    for (const float slope : {1e-1f, 1e-2f, 1e-3f, 1e-5f, 1e-7f, 1e-9f}) {
      const View nearly = view_from({0, 5 * side, 5 * slope}, {0, 0, 0});
      expect_near(nearly.right, vertical.right);
      expect_near(nearly.down, vertical.down, 2 * slope);
    }
  }
}

TEST(View, IsOrthonormalForEveryDirection) {
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        for (const glm::vec3 up :
             {glm::vec3{0, 1, 0}, glm::vec3{0, 0, 3}, glm::vec3{0, 0, -1}, glm::vec3{2, 1, 0}}) {
          const View view = view_of({.position = {x, y, z}, .target = {0, 0, 0}, .up = up});
          expect_near(glm::cross(view.right, view.down), view.forward);
          EXPECT_NEAR(glm::dot(view.right, view.forward), 0, 1e-12);
          EXPECT_NEAR(glm::length(view.right), 1, 1e-12);
          EXPECT_LE(glm::dot(view.down, glm::dvec3(up)), 1e-6);
        }
      }
    }
  }
}

Scene far_scene(const char* up) {
  Scene scene;
  scene.offset = {512000, -5412000, 128};
  scene.positions = {{1, 2, 3}};
  stand_up(scene, up);
  return scene;
}

TEST(View, TakesTheCoordinatesOfTheFile) {
  const std::vector<double> camera = {512000.25, -5412000.5, 138, 512001.25, -5412000.5, 138};
  const View as_it_is = given_view(far_scene("y"), camera);
  expect_near(as_it_is.eye, {0.25, -0.5, 10});
  expect_near(as_it_is.forward, {1, 0, 0});
  expect_near(as_it_is.down, {0, -1, 0});
  EXPECT_EQ(as_it_is.vertical_fov_degrees, 40);
  const View z_up = given_view(far_scene("z"), camera);
  expect_near(z_up.eye, {0.25, 10, 0.5});
  expect_near(z_up.forward, {1, 0, 0});
  expect_near(z_up.down, {0, -1, 0});
}

TEST(View, TakesUpAndFieldOfViewInEitherOrNone) {
  const Scene scene;
  const View with_up = given_view(scene, std::vector<double>{0, 0, 0, 0, 0, -1, 2, 2, 0});
  expect_near(with_up.down, -glm::normalize(glm::dvec3{1, 1, 0}));
  EXPECT_EQ(with_up.vertical_fov_degrees, 40);
  const View with_both = given_view(scene, std::vector<double>{0, 0, 0, 0, 0, -1, 75, 1, 0, 0});
  expect_near(with_both.down, {-1, 0, 0});
  EXPECT_EQ(with_both.vertical_fov_degrees, 75);
  EXPECT_EQ(given_view(scene, std::vector<double>{0, 0, 0, 0, 0, -1, 75}).vertical_fov_degrees, 75);
}

TEST(View, LooksFromMapNorthUpWhereZIsUp) {
  const View view =
      given_view(far_scene("z"), std::vector<double>{512000, -5412000, 200, 512000, -5412000, 0});
  const Scene scene = far_scene("z");
  expect_near(direction_to_file(scene, view.right), {1, 0, 0});
  expect_near(direction_to_file(scene, view.down), {0, -1, 0});
}

TEST(View, IsSoundForEveryNumberThatIsFinite) {
  constexpr double MAX = std::numeric_limits<double>::max(), LEAST = 1e-300;
  for (const std::vector<double>& camera :
       {std::vector<double>{MAX, 0, 0, -MAX, 0, 0},
        std::vector<double>{MAX, MAX, MAX, -MAX, -MAX, -MAX, MAX, 0, 0},
        std::vector<double>{LEAST, 0, 0, 0, 0, 0}, std::vector<double>{0, 0, 0, 1, 0, 0, 0, LEAST, 0},
        std::vector<double>{0, 0, 0, 0, LEAST, 0}}) {
    ASSERT_EQ(complaint_about_view(camera), "");
    const View view = given_view(far_scene("y"), camera);
    EXPECT_NEAR(glm::length(view.forward), 1, 1e-12);
    expect_near(glm::cross(view.right, view.down), view.forward);
  }
}

TEST(View, SaysWhatIsWrong) {
  constexpr double INF = std::numeric_limits<double>::infinity();
  const struct {
    std::vector<double> camera;
    const char* part;
  } cases[] = {{{}, "not 0"},
               {{1, 2, 3, 4, 5}, "not 5"},
               {{1, 2, 3, 4, 5, 6, 7, 8}, "not 8"},
               {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, "not 11"},
               {{NAN, 0, 0, 1, 0, 0}, "finite"},
               {{0, 0, 0, 1, 0, 0, 40, 0, INF, 0}, "finite"},
               {{1, 2, 3, 1, 2, 3}, "same point"},
               {{0, 0, 0, 1, 0, 0, 0}, "field of view"},
               {{0, 0, 0, 1, 0, 0, 180}, "field of view"},
               {{0, 0, 0, 1, 0, 0, -20, 0, 1, 0}, "field of view"},
               {{0, 0, 0, 1, 0, 0, 0, 0, 0}, "up is 0"},
               {{0, 0, 0, 1, 2, 3, 10, 20, 30}, "along"},
               {{0, 0, 0, 1, 2, 3, 40, -1, -2, -3}, "along"}};
  for (const auto& c : cases) {
    EXPECT_NE(complaint_about_view(c.camera).find(c.part), std::string::npos)
        << complaint_about_view(c.camera);
  }
}

TEST(StandUp, TurnsEachAxisIntoYAndBack) {
  for (const std::string_view up : UP_AXES) {
    Scene scene;
    scene.camera = Camera{};
    const int axis = up.back() - 'x';
    glm::vec3 position{0};
    position[axis] = up[0] == '-' ? -2 : 2;
    scene.positions = {position, {1, 2, 3}};
    stand_up(scene, up);
    EXPECT_EQ(scene.positions[0], glm::vec3(0, 2, 0)) << up;
    expect_near(to_file(scene, scene.positions[1]), {1, 2, 3});
    expect_near(to_scene(scene, {1, 2, 3}), scene.positions[1]);
    // A rotation, which mirrors nothing.
    expect_near(glm::cross(direction_to_scene(scene, {1, 0, 0}), direction_to_scene(scene, {0, 1, 0})),
                direction_to_scene(scene, {0, 0, 1}));
    EXPECT_EQ(scene.camera.has_value(), up == "y");
  }
}

}  // namespace
}  // namespace coppice
