#include "mesh/obj.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "mesh/input.h"
#include "mesh/test_support.h"

namespace accuray::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

void expect_obj_error(const std::string& text, const std::string& message) {
  expect_error([&] { return read_obj_text(text, "a.obj"); }, "a.obj:" + message);
}

TEST(Obj, Triangle) {
  MeshData mesh = read_obj_text("v 1 2 3\nv 4 5 6\nv 7 8 -9\nf 1 2 3\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.positions, (Floats{1, 2, 3, 4, 5, 6, 7, 8, -9}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_EQ(mesh.report.triangles_read, 1u);
}

TEST(Obj, ColorsOfVerticesAreKept) {
  MeshData mesh = read_obj_text("v 0 0 0\nv 1 0 0 1 .5 .25\nv 0 1 0 0 2 nan\nv 9 9 9\nf 2 3 1\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.colors, (Floats{1, .5f, .25f, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
  EXPECT_TRUE(mesh.srgb_colors);
  EXPECT_EQ(mesh.report.missing_colors, 2u);
  EXPECT_TRUE(read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").colors.empty());
}

TEST(Obj, PolygonIsAFanFromItsFirstCorner) {
  EXPECT_EQ(read_obj_text(kSquare + "f 1 2 3 4\n").indices, (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(read_obj_text(kSquare + "v -1 .5 0\nf 1 2 3 4 5\n").indices, (Indices{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(Obj, AllCornerForms) {
  std::string attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\n";
  MeshData mesh = read_obj_text(kSquare + attributes + "f 1/1/1 2/2/1 3/3/1\n");
  EXPECT_EQ(mesh.uvs, (Floats{0, 0, 1, 0, 1, 1}));
  EXPECT_EQ(mesh.normals, (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}));  // scaled to unit length
  EXPECT_EQ(read_obj_text(kSquare + attributes + "f 1/1 2/2 3/3\n").uvs, mesh.uvs);
  EXPECT_EQ(read_obj_text(kSquare + attributes + "f 1//1 2//1 3//1\n").normals, mesh.normals);
  EXPECT_TRUE(read_obj_text(kSquare + attributes + "f 1// 2/ 3\n").normals.empty());
}

TEST(Obj, NegativeIndicesCountBackFromTheLatest) {
  MeshData mesh = read_obj_text(kSquare + "f -4 -3 -2\nv 5 5 5\nf -1 -5 -4\n");
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 5, 5, 5}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 3, 0, 1}));
}

TEST(Obj, PositiveIndicesMayReferForward) {
  EXPECT_EQ(read_obj_text("f 1 2 3\n" + kSquare).positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0}));
}

TEST(Obj, EqualCornersShareAVertex) {
  MeshData mesh =
      read_obj_text(kSquare + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 4/1 3/1\nf 1/1 3/1 2/1\n");
  EXPECT_EQ(mesh.positions.size(), 3u * 5);  // four, and the first again with another uv
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3, 4, 3, 2, 0, 2, 1}));
  EXPECT_EQ(mesh.uvs, (Floats{0, 0, 0, 0, 0, 0, 0, 0, 1, 1}));
}

TEST(Obj, MissingPartsOfMixedFaces) {
  MeshData mesh = read_obj_text(kSquare + "vt .5 .25\nvn 1 0 0\nf 1/1/1 2 3/1\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.normals, (Floats{1, 0, 0, 0, 0, 1, 0, 0, 1}));  // given, then twice the smooth one
  EXPECT_EQ(mesh.uvs, (Floats{.5f, .25f, 0, 0, .5f, .25f}));
  EXPECT_EQ(mesh.report.generated_normals, 2u);
  EXPECT_EQ(mesh.report.missing_uvs, 1u);
}

TEST(Obj, LineEndsBlanksCommentsAndContinuations) {
  MeshData plain = read_obj_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_obj_text("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nf 1 2 3\r\n").positions, plain.positions);
  EXPECT_EQ(read_obj_text("# a\\\nv 0 0 0\n\n\tv\t1 0  0\t\n  v 1 1 0 # x\\\nf 1 2 3").positions, plain.positions);
  EXPECT_EQ(read_obj_text("v 0 \\\n0 0\nv 1\\\r\n 0\\\r\n 0\r\nv 1 1 0\nf 1 \\\n2 \\\n\\\n3 \\").positions,
            plain.positions);
}

TEST(Obj, NumbersOfEveryKind) {
  MeshData mesh = read_obj_text("v +1 -.5 2.\nv 1e2 -1E-2 +1.5e+1\nv 1e-60 0.1 0.30000001192092896\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions, (Floats{1, -.5f, 2, 100, -.01f, 15, 0, .1f, .3f}));
  EXPECT_EQ(read_obj_text("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0\nf 1 2 3\n").positions,
            (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(Obj, KeywordsIgnoredAndUnknown) {
  MeshData mesh =
      read_obj_text("mtllib a.mtl\no x\ng y\ns off\nusemtl m\nl 1 2\np 1\ncurv2 1 2\n" + kSquare + "f 1 2 3\nxyz\n");
  EXPECT_EQ(mesh.indices.size(), 3u);
  EXPECT_EQ(mesh.report.unknown, 2u);
  EXPECT_EQ(mesh.report.first_unknown, "curv2 in line 8");
}

TEST(Obj, MaterialsOfTriangles) {
  MeshData mesh =
      read_obj_text("mtllib a.mtl b c.mtl # x\n" + kSquare +
                    "f 1 2 3\nusemtl red paint \nf 1 2 3 4\nusemtl blue#1\nf 1 1 2\nf 1 3 4\nusemtl red paint\n"
                    "f 2 3 4\n");
  EXPECT_EQ(mesh.material_names, (std::vector<std::string>{"", "red paint", "blue#1"}));
  EXPECT_EQ(mesh.materials, (Indices{0, 1, 1, 2, 1}));  // without that of the triangle that has no area
  EXPECT_EQ(mesh.libraries, (std::vector<std::string>{"a.mtl b c.mtl"}));
  EXPECT_TRUE(read_obj_text(kSquare + "f 1 2 3\n").materials.empty());
  EXPECT_EQ(read_obj_text("usemtl x\n" + kSquare + "f 1 2 3\n").materials, (Indices{0}));
}

// Two squares that meet at a right angle.
const std::string kEdge = kSquare + "v 1 0 -1\nv 1 1 -1\n";

TEST(Obj, SmoothingGroupsMakeNormals) {
  const float half = std::sqrt(0.5f);
  MeshData one = read_obj_text(kEdge + "s 1\nf 1 2 3 4\nf 2 5 6 3\n");
  expect_valid(one);
  EXPECT_EQ(one.positions.size(), 3u * 6);
  for (size_t i = 0; i < 6; ++i) {
    bool edge = one.positions[3 * i] == 1.0f && one.positions[3 * i + 2] == 0.0f;
    EXPECT_NEAR(one.normals[3 * i], edge ? half : one.positions[3 * i + 2] == -1.0f ? 1.0f : 0.0f, 1e-6);
  }
  MeshData two = read_obj_text(kEdge + "s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
  EXPECT_EQ(two.positions.size(), 3u * 8);
  for (size_t i = 0; i < 8; ++i) EXPECT_EQ(two.normals[3 * i] + two.normals[3 * i + 2], 1.0f);
}

TEST(Obj, WithoutSmoothingGroupsOrWithNormalsNothingIsSmoothed) {
  EXPECT_TRUE(read_obj_text(kEdge + "f 1 2 3 4\ns off\nf 2 5 6 3\n").normals.empty());
  MeshData given = read_obj_text(kEdge + "vn 0 1 0\ns 1\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(given.normals, (Floats{0, 1, 0, 0, 1, 0, 0, 1, 0}));
  expect_obj_error(kEdge + "s x\n",
                   "7: smoothing group 'x' is no number: allowed a whole number from 0 to "
                   "4294967295, or off");
}

TEST(Obj, UnusableTrianglesAreCountedAndTheRestIsRead) {
  MeshData mesh = read_obj_text(kSquare +
                                "v nan 0 0\nv 1e300 0 -inf\nv 2e18 0 0\nv 1.#QNAN 0 0\nv 0 0 0\n"
                                "f 1 2 3\nf 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 8\nf 1 9 2\nf 1 1 2\nf 1 3 4\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.report.nonfinite_triangles, 4u);
  EXPECT_EQ(mesh.report.nonfinite_vertices, 4u);
  EXPECT_EQ(mesh.report.degenerate_triangles, 2u);
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(Obj, NoTriangles) {
  EXPECT_TRUE(read_obj_text("").indices.empty());
  EXPECT_TRUE(read_obj_text("# nothing\n").indices.empty());
  EXPECT_TRUE(read_obj_text(kSquare).positions.empty());
}

TEST(Obj, Errors) {
  const std::string corner = "is malformed: allowed v, v/t, v//n or v/t/n";
  expect_obj_error("v 0 0\n", "1: v has 2 numbers: allowed 3 to 6 numbers");
  expect_obj_error("\nv 0 0 0 0 0\n", "2: v has 5 numbers: allowed 3, 4 or 6 numbers");
  expect_obj_error("v 0 0 0 0 0 0 7\n", "1: v '7' is one number too many: allowed 3 to 6 numbers");
  expect_obj_error("v 0 0,5 0\n", "1: v '0,5' is no number: allowed a number such as -1.5e-3");
  expect_obj_error("v 0 +-1 0\n", "1: v '+-1' is no number: allowed a number such as -1.5e-3");
  expect_obj_error("vn 0 1\n", "1: vn has 2 numbers: allowed 3 numbers");
  expect_obj_error("vt\n", "1: vt has 0 numbers: allowed 1 to 3 numbers");
  expect_obj_error(kSquare + "f 1 2\n", "5: f has 2 corners: allowed 3 or more corners");
  expect_obj_error(kSquare + "f 1 2 x\n", "5: face corner 'x' " + corner);
  expect_obj_error(kSquare + "f 1 2 3/\x01z\n", "5: face corner '3/?z' " + corner);
  expect_obj_error(kSquare + "f 1 2 3.5\n", "5: face corner '3.5' " + corner);
  expect_obj_error(kSquare + "f 1 2 - 3\n", "5: face corner '-' " + corner);
  expect_obj_error(kSquare + "vn 0 0 1\nf 1/1/1/1 2 3\n", "6: face corner '1/1/1/1' " + corner);
  expect_obj_error(kSquare + "vn 0 0 1\nf 1/1/1 2 3\n",
                   "6: uv index '1' is out of range: allowed none, for there is no uv");
  expect_obj_error(kSquare + "vn 0 0 1\nf 1//1/1 2 3\n", "6: face corner '1//1/1' " + corner);
}

TEST(Obj, IndexErrors) {
  const std::string range = "is out of range: allowed 1 to 4 or -4 to -1";
  expect_obj_error(kSquare + "f 0 1 2\n", "5: position index '0' " + range);
  expect_obj_error(kSquare + "f 1 2 -5\n", "5: position index '-5' " + range);
  expect_obj_error(kSquare + "f 1 2 99999999999999999999999\n", "5: position index '99999999999999999999999' " + range);
  expect_obj_error(kSquare + "f 1 2 4294967295\n", "5: position index '4294967295' " + range);
  expect_obj_error(kSquare + "f 1 2 3\nf 1 2 9\n#\n", "6: position index '9' is out of range: allowed 1 to 4");
  expect_obj_error(kSquare + "f 1 2 4294967294\n", "5: position index '4294967294' is out of range: allowed 1 to 4");
  expect_obj_error("f 1 2 3\n", "1: position index '3' is out of range: allowed none, for there is no position");
  expect_obj_error(kSquare + "vn 0 0 1\nf 1//1 2//1 3//2\n", "6: normal index '2' is out of range: allowed 1 to 1");
  // The line of a continued face is its first.
  expect_obj_error(kSquare + "f 1 \\\n 2 \\\n 0\n", "5: position index '0' " + range);
}

TEST(Obj, OtherFiles) {
  expect_obj_error("ply\nformat\n", "1: this is no OBJ file: no line has a known keyword: allowed v, vt, vn, f, ...");
  auto missing = (std::filesystem::temp_directory_path() / "accuray_no_such_file.obj").string();
  expect_error([&] { return read_obj(missing); }, missing + ": the file does not exist: allowed an existing file");
  auto folder = std::filesystem::temp_directory_path().string();
  expect_error([&] { return read_obj(folder); }, folder + ": this is no file: allowed a regular file");
}

// A file is read through a window; lines across its edges, and lines longer than it, must come out the same.
TEST(Obj, FileEqualsMemory) {
  std::string text, polygon = "f";
  for (int i = 0; i < 200000; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "v %d %d.25 %d\n", i % 1013, i, (i * 7) % 331);
    text += line;
    polygon.append(" ").append(std::to_string(i + 1));
  }
  text += polygon + "\nf 1 2 3\n";
  ASSERT_GT(polygon.size(), size_t{1} << 20);
  auto path = (std::filesystem::temp_directory_path() /
               (std::string("accuray_obj_test_") + std::to_string(std::random_device{}()) + ".obj"));
  std::ofstream(path, std::ios::binary) << text;
  MeshData from_file = read_obj(path.string()), from_memory = read_obj_text(text);
  std::filesystem::remove(path);
  expect_valid(from_file);
  EXPECT_EQ(from_file.report.triangles_read, 199999u);
  EXPECT_EQ(from_file.positions, from_memory.positions);
  EXPECT_EQ(from_file.indices, from_memory.indices);
}

TEST(Obj, EveryTruncationAndByte) {
  survive_sweeps(
      "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0\nv 0 1.5e0 0\nvt 0 0\nvt 1 0\nvn 0 0 1\ns 1\nusemtl a\n"
      "f 1/1/1 2/2/1 3//1 4\ns off\nf -4 -3 \\\n-2 # text\n",
      [](const std::string& text) { return read_obj_text(text); });
}

TEST(Obj, Mutants) {
  const std::vector<std::string> seeds = {
      kSquare + "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\ng a\nf 1/1/1 2/2/2 3/1/1 4/2/2\nf -1//-1 -2//-2 -3//-1\n",
      kSquare + "# c\nf 1 2 3\nf 1 \\\n3 4\nusemtl x\nv 1e3 -2.5E-3 +7 1\nf 5 2 3\r\n"};
  const std::vector<std::string> tokens = {"nan",         "inf", "1e39", "-1",         "0",    "4294967295",
                                           "99999999999", "/",   "//",   "\\\n",       "\r\n", "\n",
                                           " ",           "f ",  "v ",   "vn 0 0 0\n", "#",    "vt 1"};
  survive_mutants(seeds, tokens, 6000, [](const std::string& text) { return read_obj_text(text); });
}

}  // namespace
}  // namespace accuray::mesh
