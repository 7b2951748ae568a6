#pragma once

#include <span>
#include <string>

#include "apps/option_groups.h"
#include "pipeline/checked_device.h"
#include "render/scene_arrays.h"

namespace coppice {

// A line that is no error, to stderr.
void print_note(const std::string& line);

// Of what was odd about the input, a line each, to stderr.
void print_warnings(std::span<const std::string> warnings);

// Opens the scene where it fits, and says what was odd about it. `on_device`: whether a device holds it.
Scene open_scene_of(const SceneOptions& scene, const BuilderChoice& builder, const DeviceSetup& device,
                    bool on_device);

// The same for a picture with the scene's effects. Shadow rays are traced through trees of one level: with
// shadows instances are not kept. Throws InputError where they would then stand still and should not.
Scene open_for_effects(const SceneOptions& scene, const BuilderChoice& builder, const DeviceSetup& device,
                       bool on_device, bool may_stand_still);

// What the stages take of a scene for its pictures, and warnings of images that are missing or broken.
SceneArrays picture_arrays(const Scene& scene, const EffectChanges& effects);

// The device that was asked for, checked; notes go to stderr. Throws DeviceError if there is no such device
// or it fails.
CheckedDevice open_device(const DeviceSetup& device, const DeviceUse& use);

// For builds of such a builder.
CheckedDevice open_device(const DeviceSetup& device, const BuilderChoice& builder);

// Prints what the validation layers said, if anything; then the exit status is 1, else 0.
int validation_status(CheckedDevice& device);

}  // namespace coppice
