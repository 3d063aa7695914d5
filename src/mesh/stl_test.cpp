#include "mesh/stl.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <random>

#include "mesh/test_support.h"

namespace accuray::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;
using Corners = std::vector<std::array<float, 3>>;

std::string word(uint32_t bits) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> (8 * i));
  return bytes;
}

// Three corners for each triangle; `declared` is what the header says, if it lies.
std::string binary(const Corners& corners, const std::string& title = "made by a test", int64_t declared = -1) {
  std::string file = title;
  file.resize(80, ' ');
  file += word(static_cast<uint32_t>(declared < 0 ? static_cast<int64_t>(corners.size() / 3) : declared));
  for (size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) file += word(0) + word(0) + word(0);  // the normal
    for (float x : corners[i]) file += word(std::bit_cast<uint32_t>(x));
    if (i % 3 == 2) file += std::string("\x12\x34", 2);
  }
  return file;
}

const Corners kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};

std::string text(const Corners& corners) {
  std::string file = "solid a b\n";
  for (size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) file += " facet normal 0 0 1\n  outer loop\n";
    file += "   vertex";
    for (float x : corners[i]) file.append(" ").append(std::to_string(x));
    file += i % 3 == 2 ? "\n  endloop\n endfacet\n" : "\n";
  }
  return file + "endsolid a b\n";
}

TEST(Stl, BinaryAndTextAreWeldedAlike) {
  for (const std::string& file : {binary(kSquare), text(kSquare)}) {
    MeshData mesh = read_stl_bytes(file);
    expect_valid(mesh);
    EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
    EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(mesh.normals.empty());
  }
}

TEST(Stl, OnlyEqualPositionsAreOne) {
  Corners corners = kSquare;
  corners[3][0] = 1e-30f;
  EXPECT_EQ(read_stl_bytes(binary(corners)).positions.size(), 3u * 5);
  corners[3][0] = -0.0f;
  EXPECT_EQ(read_stl_bytes(binary(corners)).positions.size(), 3u * 4);
}

TEST(Stl, BinaryMayBeginWithSolid) { EXPECT_EQ(read_stl_bytes(binary(kSquare, "solid x")).indices.size(), 6u); }

TEST(Stl, TextOfSeveralSolidsWithOddBlanks) {
  std::string file = text(kSquare) + "\r\n\t solid\r\nendsolid\n" + text(kSquare);
  EXPECT_EQ(read_stl_bytes(file).indices.size(), 12u);
  EXPECT_TRUE(read_stl_bytes("solid\nendsolid\n").indices.empty());
}

TEST(Stl, UnusableTrianglesAreCounted) {
  Corners corners = kSquare;
  corners[0][1] = NAN;
  corners[3] = corners[4];
  MeshData mesh = read_stl_bytes(binary(corners));
  expect_valid(mesh);
  EXPECT_EQ(mesh.report.nonfinite_triangles, 1u);
  EXPECT_EQ(mesh.report.degenerate_triangles, 1u);
}

void expect_stl_error(const std::string& file, const std::string& message) {
  expect_error([&] { return read_stl_bytes(file, "a.stl"); }, "a.stl" + message);
}

TEST(Stl, SizeLies) {
  const std::string problem = " is not that of the file's size: allowed ";
  expect_stl_error(binary(kSquare, "", 4294967295),
                   ": byte 80: number of triangles '4294967295'" + problem + "2 in 184 bytes");
  expect_stl_error(binary(kSquare, "", 1), ": byte 80: number of triangles '1'" + problem + "2 in 184 bytes");
  expect_stl_error(binary(kSquare).substr(0, 183), ": byte 80: number of triangles '2'" + problem + "1 in 183 bytes");
  expect_stl_error(binary(kSquare) + "x", ": byte 80: number of triangles '2'" + problem + "2 in 185 bytes");
  expect_stl_error("abc",
                   ": the file is too short: allowed a header of 80 bytes and a number of triangles, or the "
                   "word solid");
}

TEST(Stl, TextErrors) {
  expect_stl_error("solid\nvertex 0 0 0\n",
                   ":2: the word 'vertex' is out of place: allowed facet normal x y z, or "
                   "endsolid");
  const std::string start = "solid\nfacet normal 0 0 1\nouter loop\n";
  expect_stl_error(start + "vertex 0 0\n", ":4: vertex has too few numbers: allowed 3 numbers");
  expect_stl_error(start + "vertex 0 0 x\n", ":4: vertex 'x' is no number: allowed a number such as -1.5e-3");
  expect_stl_error(start + "vertex 0 0 0 0\n", ":4: vertex '0' is one number too many: allowed 3 numbers");
  expect_stl_error(start + "endloop\n", ":4: the word 'endloop' is out of place: allowed vertex x y z, three times");
  expect_stl_error(start, ":3: the file ends inside of a solid: allowed endsolid");
}

TEST(Stl, FileEqualsMemory) {
  Corners corners;
  for (int i = 0; i < 90000; ++i) corners.push_back({float(i % 101), float(i % 103), float(i % 107)});
  auto path = std::filesystem::temp_directory_path() /
              (std::string("accuray_stl_test_") + std::to_string(std::random_device{}()) + ".stl");
  std::ofstream(path, std::ios::binary) << binary(corners);
  MeshData from_file = read_stl(path.string()), from_memory = read_stl_bytes(binary(corners));
  std::filesystem::remove(path);
  EXPECT_EQ(from_file.positions, from_memory.positions);
  EXPECT_EQ(from_file.indices, from_memory.indices);
  EXPECT_EQ(from_file.report.triangles_read, 30000u);
}

TEST(Stl, EveryTruncationAndByte) {
  for (const std::string& file : {binary(kSquare), text(kSquare)}) {
    const size_t complete = file.rfind(" a b");  // what follows endsolid may be missing
    for (size_t size = 0; size < std::min(complete, file.size()); ++size)
      EXPECT_THROW(read_stl_bytes(file.substr(0, size)), ReadError);
    for (size_t at = 0; at < file.size(); ++at) {
      for (char byte : {'\0', '\xff', 'e'}) {
        std::string changed = file;
        changed[at] = byte;
        try {
          expect_valid(read_stl_bytes(changed));
        } catch (const ReadError&) {
        }
      }
    }
  }
}

TEST(Stl, Mutants) {
  const std::vector<std::string> tokens = {"\xff\xff\xff\xff", "nan",    "endsolid\n", "facet normal ",
                                           "vertex 1 2 3\n",   "1e99",   "\n",         " ",
                                           "endloop\n",        "solid\n"};
  auto read = [](const std::string& bytes) { return read_stl_bytes(bytes); };
  // Vertices of text that are changed stay triangles; of binary files only the size can be wrong.
  survive_mutants({text(kSquare), binary(kSquare)}, tokens, 6000, read);
}

}  // namespace
}  // namespace accuray::mesh
