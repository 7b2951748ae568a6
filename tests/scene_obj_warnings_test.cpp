// Warnings: one line a kind, what changes the picture first.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/obj_folder.h"

namespace coppice {
namespace {

using ObjWarningLines = ObjFolder;

TEST_F(ObjWarningLines, ManyMissingMaterialsGiveFewWarnings) {
  std::string text = TRIANGLE;
  for (int i = 0; i < 1000; ++i) text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  const Scene scene = load(text);
  EXPECT_EQ(scene.indices.size(), 1000u);
  EXPECT_EQ(warnings_of(scene),
            std::vector<std::string>{"scene.obj:4: material 'm0' not found, default used; 1000 such in all"});
}

TEST_F(ObjWarningLines, WhatChangesThePictureComesFirst) {
  std::string mtl;
  for (int i = 0; i < 50; ++i) mtl += "newmtl part" + std::to_string(i) + "\nd 1\nTr 1\n";
  write("m.mtl", mtl);
  const Scene scene = load(
      "mtllib m.mtl lost.mtl gone.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 nan 0\nusemtl Part0\nf 1 2 3\n"
      "usemtl painted\nf 1 2 3\nf 1 2\nusemtl bare\nf 1 2 3\nsurf 0 1 0 1 1 2 3 4\n");
  EXPECT_EQ(warnings_of(scene),
            (std::vector<std::string>{
                "scene.obj:4: vertex with a coordinate that is no finite number",
                "scene.obj:12: curves and surfaces are not read",
                "scene.obj:1: material file 'lost.mtl' not found; 2 such in all",
                "scene.obj:7: material 'painted' not found, default used; 2 such in all",
                "scene.obj:3: colours of vertices are not used",
                "scene.obj:9: face with fewer than three corners, left out",
                "scene.obj:5: material 'Part0' not found, 'part0' is used",
                "m.mtl:3: d and Tr of material 'part0' do not agree, d is used; 50 such in all"}));
}

TEST_F(ObjWarningLines, DAndTrThatAgreeAreNoWarning) {
  write("m.mtl", "newmtl a\nd 1.0000\nTr 0.0000\nnewmtl b\nTr 0.75\nd 0.25\nnewmtl c\nd 0.1\nd 0.9\n");
  const Scene scene = load("mtllib m.mtl\n" + TRIANGLE + "f 1 2 3\n");
  EXPECT_EQ(scene.materials.size(), 4u);
  EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace coppice
