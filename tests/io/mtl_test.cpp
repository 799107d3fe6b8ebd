// SPDX-License-Identifier: BSD-3-Clause
// MTL: each key and option that affects the picture, and very bad files.
#include <cmath>
#include <string>
#include <unordered_map>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/io/parse.hpp>
#include "tests/io/files.hpp"

#include "tests/support/refused.hpp"

namespace rastrum::test::mtl_test {
namespace {

/// The scene of a text's materials, with textures in `folder`.
Scene read(std::string_view text, const std::filesystem::path& folder = "nowhere") {
  Scene scene;
  std::unordered_map<std::string, std::uint32_t> by_name;
  io::parse_mtl(std::as_bytes(std::span(text)), folder / "m.mtl", scene, by_name);
  EXPECT_EQ(by_name.size(), scene.materials.size());
  for (const auto& [name, index] : by_name) EXPECT_EQ(scene.materials.at(index).name, name);
  return scene;
}

/// The only material of these statements after `newmtl m`.
Material material(const std::string& statements) {
  const Scene s = read("newmtl m\n" + statements);
  EXPECT_EQ(s.materials.size(), 1U);
  for (const std::string& w : s.warnings) ADD_FAILURE() << w;
  return s.materials.at(0);
}

/// The only warning of a file.
std::string warning(std::string_view text) {
  const Scene s = read(text);
  EXPECT_EQ(s.warnings.size(), 1U);
  return s.warnings.empty() ? "" : s.warnings[0];
}

TEST(Mtl, NothingSaid) {
  const Material m = material("");
  EXPECT_EQ(m.base_color.x, 0.0F);
  EXPECT_EQ(m.base_color.w, 1.0F);
  EXPECT_EQ(m.metallic, 0.0F);
  EXPECT_FLOAT_EQ(m.roughness, std::pow(2.0F / 3, 0.25F));  // Ns 1
  EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(read("").materials.empty());
  EXPECT_TRUE(read("# only a comment").materials.empty());
  EXPECT_TRUE(read("Kd 1 0 0\n").materials.empty());  // belongs to no material
}

TEST(Mtl, Numbers) {
  const Material m = material(" \tKd\t.5 +2.5e-1 7\t \r\n  Ke 0 2 -1\nNs 30\nPm 0.25\n");
  EXPECT_EQ(m.base_color.x, 0.5F);
  EXPECT_EQ(m.base_color.y, 0.25F);
  EXPECT_EQ(m.base_color.z, 1.0F);  // clamped from 7: a surface reflects no more than arrives
  EXPECT_EQ(m.emissive.y, 2.0F);
  EXPECT_EQ(m.emissive.z, 0.0F);
  EXPECT_FLOAT_EQ(m.roughness, 0.5F);  // (2 / 32)^(1/4)
  EXPECT_EQ(m.metallic, 0.25F);
  EXPECT_EQ(material("Ns 30\nPr 0.125\n").roughness, 0.125F);  // given directly
  EXPECT_EQ(material("Kd 0.588 0 0").base_color.x, 0.588F);    // correctly rounded
  EXPECT_EQ(material("Kd 1e-60 0 0").base_color.x, 0.0F);
  const Vec4 grey = material("Kd 0.5\n").base_color;  // one number stands for three
  EXPECT_EQ(grey.y, 0.5F);
  EXPECT_EQ(grey.z, 0.5F);
}

TEST(Mtl, Alpha) {
  EXPECT_EQ(material("d 0.25").base_color.w, 0.25F);
  EXPECT_EQ(material("d 0.25").alpha_mode, AlphaMode::blend);
  EXPECT_EQ(material("d -halo 0.25").base_color.w, 0.25F);
  EXPECT_EQ(material("Tr 0.75").base_color.w, 0.25F);
  EXPECT_EQ(material("d 1\nTr 0").alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(material("Tr 0.333\nd 0.667").base_color.w, 0.667F);
  const std::string said = warning("newmtl m\n\nTr 0.9\nd 0.9\n");
  EXPECT_TRUE(holds(said, "m.mtl:4: d and Tr of 'm' differ"));
  EXPECT_EQ(read("newmtl m\nd 0.9\nTr 0.9\n").materials.at(0).base_color.w, 0.9F);
}

TEST(Mtl, Names) {
  const Scene s = read("newmtl  a name \r\nKd 1 0 0\r\nnewmtl b\nnewmtl a name\nKd 0 1 0");
  ASSERT_EQ(s.materials.size(), 2U);
  EXPECT_EQ(s.materials[0].name, "a name");
  EXPECT_EQ(s.materials[0].base_color.x, 1.0F);  // the first of that name
  EXPECT_EQ(s.materials[1].name, "b");
  EXPECT_EQ(s.materials[1].base_color.x, 0.0F);  // nothing from the material before
}

TEST(Mtl, Maps) {
  const TempFolder folder;
  Image<Rgba8> image(1, 1);
  image(0, 0) = {1, 2, 3, 255};
  for (const char* name : {"a b.png", "-c.png", "2 d.png"})
    io::write_png(folder.path(name), std::as_const(image).view());
  const Scene s = read(
      "newmtl all\n"
      "map_Kd -blendu on -cc off -mm 0 1 -o 1 -s 2 2 -t 1 1 1 -boost 2 -texres 64 a b.png\n"
      "map_Ke -clamp on -type sphere -imfchan r a b.png\n"
      "map_d -c.png\n"
      "norm -bm 0.5 a b.png\n"
      "map_Kd_unknown x.png\nbump -bm 1 x.png\nmap_Ks x.png\nmap_Pr x.png\nbump y.png\n"
      "newmtl another\nmap_Kd -s 1 1 1 2 d.png\nmap_d -clamp off a b.png\n",
      folder.path(""));
  ASSERT_EQ(s.warnings.size(), 2U);
  EXPECT_TRUE(holds(s.warnings[0],
                    "the maps of 'all' have -s or -o of their own: all are drawn with "
                    "those of a b.png"));
  EXPECT_TRUE(
      holds(s.warnings[1], "not drawn: 2 × bump, 1 × map_Kd_unknown, 1 × map_Ks, 1 × map_Pr"));
  ASSERT_EQ(s.materials.size(), 2U);
  const Material& all = s.materials[0];
  EXPECT_EQ(all.base_color_texture, 0);
  EXPECT_EQ(all.base_color.x, 0.6F);
  EXPECT_EQ(all.emissive_texture, 1);  // clamped: a separate texture of the same file
  EXPECT_EQ(all.emissive.y, 1.0F);     // a map without its factor
  EXPECT_EQ(all.alpha_texture, 2);
  EXPECT_EQ(all.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(all.normal_texture, 0);
  EXPECT_EQ(all.normal_scale, 0.5F);
  EXPECT_EQ(s.materials[1].base_color_texture, 3);
  EXPECT_EQ(s.materials[1].alpha_texture, 0);
  ASSERT_EQ(s.textures.size(), 4U);
  EXPECT_EQ(s.textures[0].wrap_u, Wrap::repeat);
  EXPECT_EQ(s.textures[1].wrap_v, Wrap::clamp_to_edge);
  EXPECT_EQ(s.textures[2].name, "-c.png");
  EXPECT_EQ(s.textures[3].name, "2 d.png");
}

TEST(Mtl, APictureThatIsNotThereLeavesTheMaterialWithout) {
  const TempFolder folder;
  const Image<Rgba8> image(1, 1);
  io::write_png(folder.path("there.png"), image.view());
  const Scene s =
      read("newmtl m\nd 0.5\nmap_Kd gone.png\nmap_d gone.png\nnorm there.png\nmap_Ke gone.png\n",
           folder.path(""));
  const Material& m = s.materials.at(0);
  EXPECT_EQ(m.alpha_mode, AlphaMode::blend) << "no mask without its map";
  EXPECT_EQ(m.alpha_texture, kNoTexture);
  EXPECT_EQ(m.base_color_texture, kNoTexture);
  EXPECT_EQ(m.normal_texture, 0);
  EXPECT_EQ(m.emissive, Vec3{});
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(holds(s.warnings[0], "gone.png"));
}

TEST(Mtl, WhatCannotBeReadIsPassedOver) {
  for (const auto& [text, says] :
       {std::pair{"newmtl m\nKd red\n", "m.mtl:2: Kd wants a number, found 'red'"},
        {"newmtl m\nKd 1 2\n", "found the end of the line"},
        {"newmtl m\nKd 0.5,1,1\n", "'0.5,1,1'"},
        {"newmtl m\nNs", "m.mtl:2: Ns wants a number"},
        {"newmtl m\nd nan\n", "m.mtl:2: d is not finite"},
        {"newmtl m\nKe 1 1e999 1\n", "Ke is not finite"},
        {"newmtl m\nPr -inf\n", "Pr is not finite"},
        {"newmtl m\nmap_Kd -clamp on\n", "wants the name of a picture"},
        {"newmtl\nKd 1 1 1\n", "m.mtl:1: newmtl without a name"}})
    EXPECT_TRUE(holds(warning(text), says));
  const Scene s = read("newmtl m\nKd 1 1 1\nd 0.5\nKd x y z\nd\nNs ten\n");
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(holds(s.warnings[0], ":4: Kd wants a number, found 'x' (and 2 more)"));
  EXPECT_EQ(s.materials.at(0).base_color.x, 1.0F);
  EXPECT_EQ(s.materials.at(0).base_color.w, 0.5F);
}

TEST(Mtl, OddBytes) {
  EXPECT_TRUE(read(std::string("\0\0\xff\n\r\r\v\f", 8)).materials.empty());
  EXPECT_EQ(read("unknown\nillum 2\nnewmtl m\nKdx 1 1 1\nTf 1\nunknown -x").warnings.size(), 1U);
  std::string many = "newmtl m\n";
  for (int i = 0; i < 100000; ++i) many += "key" + std::to_string(i) + "\xFF 1\n";
  EXPECT_LT(warning(many).size(), 200U);
  const std::string huge(1 << 22, 'x');
  EXPECT_EQ(read("newmtl " + huge).materials.at(0).name, huge);
  const std::string said = warning("newmtl m\nKd " + huge + "\n");
  EXPECT_LT(said.size(), 100U);
  // All lines are wrong, and there is one warning.
  std::string wrong = "newmtl m\n";
  for (int i = 0; i < 200000; ++i) wrong += "Kd\n";
  EXPECT_TRUE(holds(warning(wrong), "(and 199999 more)"));
}

}  // namespace
}  // namespace rastrum::test::mtl_test
