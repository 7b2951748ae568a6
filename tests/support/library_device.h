#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "consumer/own_device.h"
#include "coppice/build.h"
#include "interface/trace.h"

namespace coppice {

// A device that the test has made and the library adopts, under the validation layers.
class LibraryTest : public testing::Test {
 protected:
  static const RequiredFeatures& features() {
    static const RequiredFeatures features;
    return features;
  }

  static consumer::OwnDevice& own() {
    static consumer::OwnDevice own(features().features, true);
    return own;
  }

  static AdoptedDevice adopted() {
    AdoptedDevice device;
    device.instance = own().instance;
    device.physical_device = own().physical;
    device.device = own().device;
    device.queue_family = consumer::OwnDevice::family;
    device.enabled_features = &features().features;
    device.queue = own().queue;
    return device;
  }

  static const Context& context() {
    static const Context context(adopted());
    return context;
  }

  void TearDown() override {
    for (const std::string& message : own().take_messages()) ADD_FAILURE() << message;
  }

  template <class T>
  static consumer::Buffer upload(const std::vector<T>& values) {
    return own().upload(std::span<const T>(values));
  }

  static MemoryRange range_of(const consumer::Buffer& buffer) { return {buffer.buffer, 0, buffer.bytes}; }

  // What lies at an address of the buffer.
  template <class T>
  static std::vector<T> read(const consumer::Buffer& buffer, VkDeviceAddress address, std::size_t count) {
    const auto values = buffer.as<T>(address - buffer.address).first(count);
    return {values.begin(), values.end()};
  }
};

// With trees that are built there.
class LibraryTreeTest : public LibraryTest {
 protected:
  // A tree, and the memory it lies in.
  struct Built {
    consumer::Buffer tree;
    TreeAddresses addresses;

    BuildState state() const { return read<BuildState>(tree, addresses.state, 1)[0]; }
    std::vector<Node> nodes() const {
      const std::uint32_t active = state().active_count;
      return read<Node>(tree, addresses.nodes, active ? 2 * active - 1 : 0);
    }
  };

  template <class Input>
  static Built build(const Builder& builder, const Input& input) {
    constexpr bool boxes = std::is_same_v<Input, BoxInput>;
    const auto tree = own().make_buffer(builder.sizes().tree_bytes);
    const auto scratch = own().make_buffer(builder.sizes().scratch_bytes);
    const VkCommandBuffer commands = own().begin();
    builder.cmd_build(commands, input, range_of(tree), range_of(scratch));
    own().run(commands);
    return {tree, boxes ? builder.box_tree(range_of(tree)) : builder.triangle_tree(range_of(tree))};
  }

  static TriangleInput plain(const consumer::Buffer& triangles, std::uint32_t count) {
    TriangleInput input;
    input.vertices = triangles.address;
    input.vertex_count = 3 * count;
    input.count.maximum = count;
    return input;
  }

  static void expect_nodes(const Built& built, const std::vector<Node>& expected, const char* what) {
    EXPECT_EQ(built.state().error_word, 0u) << what;
    const std::vector<Node> nodes = built.nodes();
    ASSERT_EQ(nodes.size(), expected.size()) << what;
    EXPECT_EQ(std::memcmp(nodes.data(), expected.data(), nodes.size() * sizeof(Node)), 0) << what;
  }
};

}  // namespace coppice
