// How a hand moves the window's camera, and that --camera takes what it copies.
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/camera_control.h"

namespace coppice {
namespace {

Scene scene_far_away() {
  Scene scene;
  scene.offset = {512352, 128, -5412344};
  scene.scale_exponent = 3;
  stand_up(scene, "z");
  return scene;
}

View hand_view(const std::vector<double>& numbers) { return given_view(Scene(), numbers); }

void expect_close_points(glm::dvec3 a, glm::dvec3 b, double limit = 1e-9) {
  EXPECT_LT(glm::length(a - b), limit);
}

TEST(CameraControl, NumbersGiveTheViewAgainWhereverTheSceneCameFrom) {
  for (const Scene& scene : {Scene(), scene_far_away()}) {
    const std::vector<double> given = {scene.offset.x + 3,
                                       scene.offset.y + 2,
                                       scene.offset.z + 7,
                                       scene.offset.x,
                                       scene.offset.y + 0.5,
                                       scene.offset.z,
                                       35};
    const View view = given_view(scene, given);
    const std::vector<double> numbers = camera_numbers(scene, view);
    ASSERT_EQ(numbers.size(), 7u);
    const View again = given_view(scene, numbers);
    expect_close_points(again.eye, view.eye, 1e-6);
    expect_close_points(again.forward, view.forward);
    EXPECT_EQ(again.vertical_fov_degrees, 35);
    const View held = given_view(scene, CameraControl(view, 10).numbers(scene));
    expect_close_points(held.eye, view.eye, 1e-6);
    expect_close_points(held.forward, view.forward);
    expect_close_points(held.down, view.down);
  }
}

TEST(CameraControl, ACameraThatIsNotUprightHasItsUpInTheNumbers) {
  const View view = hand_view({0, 0, 5, 0, 0, 0, 40, 1, 1, 0});
  const std::vector<double> numbers = camera_numbers(Scene(), view);
  ASSERT_EQ(numbers.size(), 10u);
  EXPECT_EQ(complaint_about_view(numbers), "");
  expect_close_points(hand_view(numbers).down, view.down);
}

TEST(CameraControl, TextIsReadBackExactly) {
  const std::vector<double> numbers = {1.0 / 3, -0.1, 1e-300, 5412344.000000001, 0, -7, 40};
  const std::string text = camera_text(numbers);
  const char* at = text.data();
  for (const double number : numbers) {
    double read = 0;
    at = std::from_chars(at, text.data() + text.size(), read).ptr + 1;
    EXPECT_EQ(read, number) << text;
  }
}

TEST(CameraControl, OrbitKeepsTheDistanceAndFollowsTheHand) {
  CameraControl camera(hand_view({0, 0, 5, 0, 0, 0, 40}), 2);
  camera.orbit(0.5, 0);  // to the right by half of the picture: a quarter turn, the eye goes to the left
  std::vector<double> n = camera.numbers(Scene());
  expect_close_points({n[0], n[1], n[2]}, {-5, 0, 0});
  camera.orbit(0, 0.25);  // down: the eye goes up
  n = camera.numbers(Scene());
  expect_close_points({n[0], n[1], n[2]}, {-5 * std::sqrt(0.5), 5 * std::sqrt(0.5), 0});
  camera.orbit(0, 10);  // never over the top
  n = camera.numbers(Scene());
  EXPECT_NEAR(glm::length(glm::dvec3(n[0], n[1], n[2])), 5, 1e-9);
  EXPECT_EQ(complaint_about_view(n), "");
  EXPECT_LT(n[0], 0);
}

TEST(CameraControl, PanMovesWhatIsSeenWithTheHand) {
  CameraControl camera(hand_view({0, 0, 5, 0, 0, 0, 90}), 2);
  camera.pan(0.5, 0.25);  // the picture is 10 high at the target
  const std::vector<double> n = camera.numbers(Scene());
  expect_close_points({n[0], n[1], n[2]}, {-5, 2.5, 5});
  expect_close_points({n[3], n[4], n[5]}, {-5, 2.5, 0});
}

TEST(CameraControl, ZoomNeverReachesTheTarget) {
  CameraControl camera(hand_view({0, 0, 5, 0, 0, 0, 40}), 2);
  camera.zoom(1);
  EXPECT_NEAR(camera.numbers(Scene())[2], 4.5, 1e-12);
  for (int i = 0; i < 1000; ++i) camera.zoom(10);
  EXPECT_EQ(complaint_about_view(camera.numbers(Scene())), "");
  for (int i = 0; i < 1000; ++i) camera.zoom(-10);
  EXPECT_TRUE(std::isfinite(camera.numbers(Scene())[2]));
}

TEST(CameraControl, LookingAroundLeavesTheEyeAndFlyingGoesWhereItLooks) {
  CameraControl camera(hand_view({1, 2, 3, 1, 2, 0, 60}), 10);
  camera.look(1.5, 0);  // 90 degrees to the right
  std::vector<double> n = camera.numbers(Scene());
  expect_close_points({n[0], n[1], n[2]}, {1, 2, 3});
  expect_close_points({n[3], n[4], n[5]}, {4, 2, 3});
  camera.fly(0.1, 0.2, 0.3);  // in tens
  n = camera.numbers(Scene());
  expect_close_points({n[0], n[1], n[2]}, {2, 5, 5});
}

}  // namespace
}  // namespace coppice
