#pragma once

#include <gtest/gtest.h>

#include <span>
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

}  // namespace coppice
