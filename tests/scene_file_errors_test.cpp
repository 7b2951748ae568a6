// Scene files: every error names its place.
#include <gtest/gtest.h>

#include "support/scene_file_text.h"

namespace coppice {
namespace {

using nlohmann::json;

TEST(SceneFiles, EveryErrorNamesItsPlaceAndWhatWasExpected) {
  struct Fault {
    const char* pointer;
    json value;  // null: taken out
    const char* says;
  };
  const std::vector<Fault> faults = {
      {"/objects", nullptr, "s.json: key \"objects\" is missing"},
      {"/objekts", 1, "s.json: /objekts: unknown key, expected $schema, ambient_occlusion, camera"},
      {"/objects/0/positon", 1,
       "s.json: /objects/0/positon: unknown key, expected deform, keyframes, material"},
      {"/objects/0", 5, "s.json: /objects/0: 5, expected an object"},
      {"/objects/0/mesh", "x", "s.json: /objects/0/mesh: no mesh 'x', there are: q, t, walk"},
      {"/objects/0/mesh", 3, "s.json: /objects/0/mesh: 3, expected a string"},
      {"/objects/0/mesh", nullptr, ""},
      {"/objects/0/material", "x", "s.json: /objects/0/material: no material 'x', there are: none"},
      {"/objects/0/parent", "x", "s.json: /objects/0/parent: 'x', expected the name of an object"},
      {"/objects/0/translation", {1, 2}, "s.json: /objects/0/translation: [1,2], expected an array of 3"},
      {"/objects/0/translation/1", "a", "s.json: /objects/0/translation/1: \"a\", expected a number from"},
      {"/objects/0/rotation",
       {0, 0, 0, 0},
       "s.json: /objects/0/rotation: [0,0,0,0], expected a quaternion that is"},
      {"/objects/0/rotation",
       {1, 0, 0},
       "s.json: /objects/0/rotation: [1,0,0], expected a quaternion of 4 numbers"},
      {"/objects/0/rotation",
       {{"axis", {0, 1, 0}}},
       "s.json: /objects/0/rotation: key \"degrees\" is missing"},
      {"/objects/0/rotation",
       {{"axis", {0, 0, 0}}, {"degrees", 1}},
       "s.json: /objects/0/rotation/axis: [0,0,0], exp"},
      {"/objects/0/scale", "big", "s.json: /objects/0/scale: \"big\", expected a number or an array of 3"},
      {"/objects/0/matrix",
       {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 1}},
       "s.json: /objects/0/matrix/3: [0,0,1,1], expected [0,0,0,1]"},
      {"/objects/0/keyframes",
       {{"turn", 1}},
       "s.json: /objects/0/keyframes/turn: unknown key, expected rotation, sc"},
      {"/objects/0/keyframes",
       {{"translation", {{"times", {0, 0}}, {"values", {{1, 1, 1}, {1, 1, 1}}}}}},
       "s.json: /objects/0/keyframes/translation/times/1: 0, expected more than the time before"},
      {"/objects/0/keyframes",
       {{"scale", {{"times", {0, 1}}, {"values", {{1, 1, 1}}}}}},
       "s.json: /objects/0/keyframes/scale/values: 1 values, expected one for each of the 2 times"},
      {"/objects/0/keyframes",
       {{"rotation", {{"times", {0}}, {"axis", {0, 1, 0}}}}},
       "s.json: /objects/0/keyframes/rotation: expected either \"values\" or both \"axis\" and \"degrees\""},
      {"/objects/0/keyframes",
       {{"scale", {{"times", {0}}, {"values", {{1, 1, 1}}}, {"interpolation", "bounce"}}}},
       "/scale/interpolation: \"bounce\", expected \"step\", \"linear\" or \"cubic\""},
      {"/objects/0/deform",
       {{"kind", "melt"}},
       "s.json: /objects/0/deform/kind: \"melt\", expected \"wave\""},
      {"/objects/0/deform",
       {{"kind", "wave"}, {"piece_triangles", 2}},
       "/deform/piece_triangles: does not go with"},
      {"/objects/0/deform",
       {{"kind", "wave"}, {"seconds", 0}},
       "/deform/seconds: 0, expected a number from 1e-06 to 1000000"},
      {"/objects/0/deform",
       {{"kind", "wave"}, {"seconds", 1e-60}},
       "s.json: /objects/0/deform/seconds: 1e-60, expected a number from 1e-06 to 1000000"},
      {"/objects/0/deform",
       {{"kind", "twist"}, {"size", 1e-60}},
       "s.json: /objects/0/deform/size: 1e-60, expected a number from 1e-30 to 1e+30"},
      {"/meshes/t", json::object(), "s.json: /meshes/t: expected one of the keys \"file\", \"built_in\""},
      {"/meshes/t/built_in", "grove", "s.json: /meshes/t/built_in: beside \"file\", expected one of them"},
      {"/meshes/t/repeat", true, "s.json: /meshes/t/repeat: does not go with \"file\""},
      {"/meshes/t/animation", "run", "s.json: /meshes/t/animation: does not go with a file that is not glTF"},
      {"/meshes/t/file", "x.obj", "s.json: /meshes/t/file: x.obj: no such file"},
      {"/meshes/t/file", "other.json",
       "/meshes/t/file: 'other.json', a scene file in a scene file is not read, exp"},
      {"/meshes/t/file", "x.stl", "s.json: /meshes/t/file: 'x.stl', expected an .obj, .gltf, .glb or .ply"},
      {"/meshes/t",
       {{"built_in", "bunny"}},
       "s.json: /meshes/t/built_in: unknown scene 'bunny', expected a built-in"},
      {"/meshes/t",
       {{"built_in", "scatter:0"}},
       "s.json: /meshes/t/built_in: scene 'scatter:0': '0' is no number"},
      {"/meshes/t", {{"anim", "a.anim"}}, "s.json: /meshes/t: key \"faces\" is missing"},
      {"/meshes/t", {{"anim", "a.anim"}, {"faces", "t.obj"}}, "s.json: /meshes/t/anim: a.anim: no such file"},
      {"/meshes/t",
       {{"sequence", {{"pattern", "a.obj"}, {"last", 1}}}},
       "/sequence/pattern: \"a.obj\", expected #"},
      {"/meshes/t",
       {{"sequence", {{"pattern", "a#.obj"}}}},
       "s.json: /meshes/t/sequence: key \"last\" is missing"},
      {"/meshes/t",
       {{"sequence", {{"pattern", "a#.obj"}, {"first", 3}, {"last", 1}}}},
       "/sequence/last: 1, expected"},
      {"/meshes/t",
       {{"anim", "a.anim"}, {"faces", "t.obj"}, {"frames_per_second", 1e-60}},
       "s.json: /meshes/t/frames_per_second: 1e-60, expected a number from 1e-06 to 1"},
      {"/meshes/t",
       {{"sequence", json::object()}},
       "/meshes/t/sequence: expected one of the keys \"files\", \"pat"},
      {"/camera", {{"position", {0, 0, 0}}}, "s.json: /camera: key \"target\" is missing"},
      {"/camera",
       {{"position", {0, 0, 0}}, {"target", {0, 0, 0}}},
       "s.json: /camera: at 0.000000 seconds the position"},
      {"/camera", {{"position", {0, 1, 0}}, {"target", {0, 0, 0}}}, "up points along the line of sight"},
      {"/camera",
       {{"position", {0, 0, 1}}, {"target", {0, 0, 0}}, {"fov", 180}},
       "/camera/fov: 180, expected a number"},
      {"/camera",
       {{"position", {0, 0, 1}}, {"target", {0, 0, 0}}, {"fov", 1e-60}},
       "s.json: /camera/fov: 1e-60, expected a number from 0.01 to 179"},
      {"/ambient_occlusion",
       {{"distance", 0}},
       "s.json: /ambient_occlusion/distance: 0, expected a number from 1e-30 to 1e+30"},
      {"/ambient_occlusion", true, "s.json: /ambient_occlusion: true, expected an object"},
      {"/ambient_occlusion",
       {{"radius", 1}},
       "s.json: /ambient_occlusion/radius: unknown key, expected distance"},
      {"/camera",
       {{"position", {0, 0, 1}}, {"target", {0, 0, 0}}, {"aperture", -1}},
       "s.json: /camera/aperture: -1, expected a number from 0 to 1e+30"},
      {"/camera",
       {{"position", {0, 0, 1}}, {"target", {0, 0, 0}}, {"focus", 0}},
       "s.json: /camera/focus: 0, expected a number from 1e-30 to 1e+30"},
      {"/light",
       {{"direction", {0, 0, 0}}},
       "s.json: /light/direction: [0,0,0], expected a direction that is not 0"},
      {"/light", {{"radiance", {-1, 0, 0}}}, "s.json: /light/radiance/0: -1, expected a number from 0"},
      {"/up", "up", "s.json: /up: \"up\", expected \"x\", \"y\", \"z\""},
      {"/duration", 0, "s.json: /duration: 0, expected a number from 1e-06"},
      {"/materials",
       {{"a/b", {{"diffuse", 1}}}},
       "s.json: /materials/a~1b/diffuse: 1, expected an array of 3"},
  };
  for (const auto& [pointer, value, says] : faults) {
    json broken = with_object();
    const json::json_pointer place(pointer);
    if (value.is_null()) {
      broken[place.parent_pointer()].erase(place.back());
    } else {
      if (place == json::json_pointer("/objects/0/translation/1"))
        broken["objects"][0]["translation"] = {0, 0, 0};
      broken[place] = value;
    }
    const std::string message = scene_error_of(broken);
    EXPECT_NE(message.find(says), message.npos) << pointer << ": " << message;
    EXPECT_EQ(message.empty(), *says == 0) << pointer << ": " << message;
  }
  json cycle = with_object({{"name", "a"}, {"parent", "b"}});
  cycle["objects"].push_back({{"name", "b"}, {"parent", "a"}});
  EXPECT_EQ(scene_error_of(cycle),
            "s.json: /objects/0/parent: the object is below itself (a cycle), expected a tree");
  cycle["objects"][1]["name"] = "a";
  EXPECT_EQ(scene_error_of(cycle), "s.json: /objects/1/name: 'a' again, expected another name");
  json moving = with_object({{"mesh", "walk"}, {"deform", {{"kind", "explode"}}}});
  EXPECT_EQ(scene_error_of(moving),
            "s.json: /objects/0/deform/kind: \"explode\" needs vertices that no animation moves");
}

}  // namespace
}  // namespace coppice
