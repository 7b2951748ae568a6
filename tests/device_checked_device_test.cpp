// What a checked device says of plans: its own choices, or those of the caller.
#include <gtest/gtest.h>

#include <stdexcept>

#include "pipeline/checked_device.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class CheckedDeviceTest : public DeviceTest {
 protected:
  static CheckedDevice opened(const DeviceChoices& choices, Note note = {}) {
    DeviceOptions options;
    options.validate = true;
    return CheckedDevice(options, choices, {}, std::move(note));
  }

  static TraceOptions picture(std::uint32_t width, std::uint32_t height) {
    TraceOptions trace;
    trace.width = width;
    trace.height = height;
    return trace;
  }
};

TEST_F(CheckedDeviceTest, BuildsAsItIsToldOrAsTheCheckSays) {
  for (const LookbackChoice lookback : {LookbackChoice::on, LookbackChoice::off}) {
    CheckedDevice device = opened({.lookback = lookback, .variants = "sort=scan-11"});
    BuildOptions wanted;
    wanted.radius = 7;
    const BuildOptions build = device.build_options(wanted);
    EXPECT_EQ(build.radius, 7u);
    EXPECT_EQ(build.lookback, lookback == LookbackChoice::on);
    EXPECT_EQ(build.variants.sort, SORT_SCAN_11);
    EXPECT_EQ(build.variants.trace, default_variants(device.properties()).trace);
    EXPECT_TRUE(device.device().take_validation_messages().empty());
  }
  EXPECT_THROW(opened({.variants = "sort=nonsense"}), std::invalid_argument);
}

TEST_F(CheckedDeviceTest, WalksTheWideTreeWhereItPays) {
  CheckedDevice device = opened({.variants = "trace=wide-single"});
  EXPECT_EQ(device.picture_options(picture(10, 10), 399).walk, Walk::wide_single);
  EXPECT_EQ(device.picture_options(picture(10, 10), 400).walk, Walk::binary);
  TraceOptions fast = picture(10, 10);
  fast.box_test = BOX_FAST;
  EXPECT_EQ(device.picture_options(fast, 1).walk, Walk::binary);
  TraceOptions none = picture(10, 10);
  none.walk = Walk::brute_force;
  EXPECT_EQ(device.picture_options(none, 1).walk, Walk::brute_force);
  EXPECT_EQ(opened({.variants = "trace=binary"}).picture_options(picture(10, 10), 1).walk, Walk::binary);
}

TEST_F(CheckedDeviceTest, WalksAsItIsToldOrSaysWhyNot) {
  WalkChoice packets, any_wide;
  packets.walk = Walk::wide_packets;
  any_wide.any_wide = true;
  any_wide.said = "that tree";
  CheckedDevice told = opened({.walk = packets}),
                asked = opened({.variants = "trace=wide-single", .walk = any_wide});
  EXPECT_EQ(told.picture_options(picture(1, 1), 1000).walk, Walk::wide_packets);
  EXPECT_EQ(asked.picture_options(picture(1, 1), 1000).walk, Walk::wide_single);
  TraceOptions fast = picture(1, 1);
  fast.triangle_test = TRIANGLE_FAST;
  try {
    asked.picture_options(fast, 1);
    FAIL() << "the wide tree with the fast test";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find("that tree is traced with"), 0u) << error.what();
  }
}

TEST_F(CheckedDeviceTest, HandsItsNotesToTheCaller) {
  std::vector<std::string> lines;
  CheckedDevice device = opened({}, [&](const std::string& line) { lines.push_back(line); });
  lines.clear();  // of a slow driver
  device.note("one");
  device.note_once("two");
  device.note_once("two");
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two"}));
}

}  // namespace
}  // namespace coppice
