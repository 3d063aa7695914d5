#include "mesh/ply.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "mesh/test_support.h"

namespace accuray::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;

const std::string kAscii = "ply\nformat ascii 1.0\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFace = "property list uchar int vertex_indices\nend_header\n";
const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::string kHeader = kAscii + "element vertex 4\n" + kXyz + "element face 1\n" + kFace;

void expect_ply_error(const std::string& bytes, const std::string& message) {
  expect_error([&] { return read_ply_bytes(bytes, "a.ply"); }, "a.ply" + message);
}

// Bytes of a value in the given order.
template <class T>
std::string bytes_of(T value, std::endian order) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return order == std::endian::native ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

// A square with all attributes, properties of odd types between them, and an element to skip.
std::string binary_square(std::endian order, const std::string& line_end = "\n") {
  std::string lines[] = {
      "ply",
      std::string("format binary_") + (order == std::endian::little ? "little" : "big") + "_endian 1.0",
      "comment made by hand",
      "element vertex 4",
      "property double x",
      "property float32 y",
      "property short z",
      "property uchar red",
      "property list uint8 float64 extra",
      "property float nx",
      "property int8 ny",
      "property float nz",
      "property float s",
      "property uint16 t",
      "element edge 2",
      "property int a",
      "property list ushort uint8 b",
      "element face 1",
      "property int32 flags",
      "property list uint32 uint16 vertex_index",
      "obj_info x",
      "end_header"};
  std::string file;
  for (const std::string& line : lines) file += line + line_end;
  const double x[] = {0, 1, 1, 0}, y[] = {0, 0, 1, 1};
  for (int i = 0; i < 4; ++i) {
    file += bytes_of(x[i], order) + bytes_of(static_cast<float>(y[i]), order) + bytes_of(int16_t{-3}, order) + '\x7f';
    file += '\x02' + bytes_of(1.0, order) + bytes_of(2.0, order);
    file += bytes_of(0.0f, order) + '\x00' + bytes_of(-1.0f, order);
    file += bytes_of(static_cast<float>(x[i]) / 4, order) + bytes_of(static_cast<uint16_t>(i), order);
  }
  for (int i = 0; i < 2; ++i) file += bytes_of(int32_t{i}, order) + bytes_of(uint16_t{3}, order) + "abc";
  file += bytes_of(int32_t{9}, order) + bytes_of(uint32_t{4}, order);
  for (uint16_t i : {0, 1, 2, 3}) file += bytes_of(i, order);
  return file;
}

TEST(Ply, Ascii) {
  MeshData mesh = read_ply_bytes(kHeader + kSquare + "4 0 1 2 3\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, BinaryInBothOrders) {
  for (std::endian order : {std::endian::little, std::endian::big}) {
    for (const std::string line_end : {"\n", "\r\n"}) {
      MeshData mesh = read_ply_bytes(binary_square(order, line_end));
      expect_valid(mesh);
      EXPECT_EQ(mesh.positions, (Floats{0, 0, -3, 1, 0, -3, 1, 1, -3, 0, 1, -3}));
      EXPECT_EQ(mesh.normals, (Floats{0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1}));
      EXPECT_EQ(mesh.uvs, (Floats{0, 0, .25f, 1, .25f, 2, 0, 3}));
      EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 0, 2, 3}));
      EXPECT_EQ(mesh.report.unknown, 5u);
      EXPECT_EQ(mesh.report.first_unknown, "vertex red");
    }
  }
}

TEST(Ply, AsciiWithAllNames) {
  for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    std::string header = kAscii;
    header.append("element vertex 3\n").append(kXyz);
    for (const char* name : {"nx", "ny", "nz", u, v}) header.append("property float ").append(name).append("\n");
    header += "element face 1\nproperty list uint8 int32 vertex_index\nend_header\n";
    MeshData mesh = read_ply_bytes(header + "0 0 0 0 0 2 .1 .2\n\n1 0 0 0 0 1 .3 .4\r\n0\t1 0 0 0 1 .5 .6\n3 0 1 2");
    expect_valid(mesh);
    EXPECT_EQ(mesh.uvs, (Floats{.1f, .2f, .3f, .4f, .5f, .6f}));
    EXPECT_EQ(mesh.normals, (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  }
}

TEST(Ply, ColorsOfVerticesAreKept) {
  auto colored = [](const std::string& type, const std::string& names, const std::string& values) {
    std::string header = kAscii;
    header.append("element vertex 3\n").append(kXyz);
    for (std::string_view rest = names; !rest.empty(); rest.remove_prefix(1)) {
      const char* name = rest[0] == 'r' ? "red" : rest[0] == 'g' ? "green" : rest[0] == 'b' ? "blue" : "alpha";
      header.append("property ").append(type).append(" ").append(name).append("\n");
    }
    header.append("element face 1\n").append(kFace);
    for (const char* position : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) header.append(position).append(values).append("\n");
    return read_ply_bytes(header + "3 0 1 2\n");
  };
  auto thrice = [](const Floats& one) {
    Floats all;
    for (int i = 0; i < 3; ++i) all.insert(all.end(), one.begin(), one.end());
    return all;
  };
  EXPECT_EQ(colored("uchar", "rgb", "255 51 0").colors, thrice({1, .2f, 0, 1}));
  EXPECT_TRUE(colored("uchar", "rgb", "255 51 0").srgb_colors);
  EXPECT_EQ(colored("ushort", "abgr", "0 65535 13107 0").colors, thrice({0, .2f, 1, 0}));
  EXPECT_EQ(colored("float", "rgba", "3 .5 -1 .25").colors, thrice({3, .5f, -1, .25f}));
  EXPECT_FALSE(colored("float", "rgba", "3 .5 -1 .25").srgb_colors);
  EXPECT_TRUE(colored("uchar", "rb", "3 4").colors.empty());
  EXPECT_TRUE(colored("int", "rgb", "3 4 5").colors.empty());
  EXPECT_EQ(colored("int", "rgb", "3 4 5").report.unknown, 3u);
}

TEST(Ply, FacesBeforeVerticesAndElementsWithoutProperties) {
  std::string header = kAscii +
                       "element nothing 4294967296000\nelement face 1\nproperty list uchar int vertex_indices\n" +
                       "element vertex 3\n" + kXyz + "end_header\n";
  EXPECT_EQ(read_ply_bytes(header + "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n").indices, (Indices{0, 1, 2}));
}

TEST(Ply, UnusableTrianglesAreCounted) {
  std::string header =
      kAscii + "element vertex 5\nproperty double x\nproperty float y\nproperty float z\nelement face 4\n" + kFace;
  MeshData mesh =
      read_ply_bytes(header + "nan 0 0\n0 0 0\n1 0 0\n0 1 0\n1e200 0 0\n3 0 1 2\n3 1 2 3\n3 1 2 4\n3 1 2 1\n");
  expect_valid(mesh);
  EXPECT_EQ(mesh.report.nonfinite_triangles, 2u);
  EXPECT_EQ(mesh.report.degenerate_triangles, 1u);
  EXPECT_EQ(mesh.report.nonfinite_vertices, 2u);
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(Ply, Empty) {
  EXPECT_TRUE(read_ply_bytes(kAscii + "element vertex 0\n" + kXyz + "element face 0\n" + kFace).indices.empty());
}

TEST(Ply, HeaderErrors) {
  expect_ply_error("", ":1: the header ends too early: allowed a header that ends with end_header");
  expect_ply_error("obj\n", ":1: the first line 'obj' is wrong: allowed ply");
  const std::string formats =
      "is wrong: allowed format ascii 1.0, format binary_little_endian 1.0 or format binary_big_endian 1.0";
  expect_ply_error("ply\nformat ascii 2.0\n", ":2: format line 'format ascii 2.0' " + formats);
  expect_ply_error("ply\nelement vertex 3\n", ":2: format line 'element vertex 3' " + formats);
  expect_ply_error(kAscii + "element vertex -3\n",
                   ":3: element line 'element vertex -3' is wrong: allowed element NAME COUNT");
  expect_ply_error(kAscii + "property float x\n",
                   ":3: property line 'property float x' comes too early: allowed an element before it");
  expect_ply_error(kAscii + "element v 1\nproperty half x\n",
                   ":4: type 'half' is unknown: allowed char, uchar, short, ushort, int, uint, float, double, int8, "
                   "uint8, ..., float64");
  expect_ply_error(kAscii + "element v 1\nproperty list float int x\n",
                   ":4: list length in 'property list float int x' is no integer: allowed an integer type");
  expect_ply_error(kAscii + "element v 1\nproperty int x\nproperty int x\n",
                   ":5: property 'x' is declared twice: allowed one of each name in an element");
  expect_ply_error(kAscii + "element v 1\nelement v 1\n",
                   ":4: element 'v' is declared twice: allowed one of each name");
  expect_ply_error(kAscii + "bogus\n",
                   ":3: header keyword 'bogus' is unknown: allowed comment, obj_info, element, property or end_header");
  expect_ply_error(kAscii + "element vertex 1\n" + kXyz,
                   ":6: the header ends too early: allowed a header that ends with end_header");
}

TEST(Ply, ElementErrors) {
  expect_ply_error(kAscii + "end_header\n",
                   ": element vertex is missing: allowed both element vertex and element face");
  expect_ply_error(kAscii + "element vertex 0\n" + kXyz + "end_header\n",
                   ": element face is missing: allowed both element vertex and element face");
  expect_ply_error(kAscii + "element vertex 0\nproperty float x\nelement face 0\n" + kFace,
                   ":3: element vertex lacks a property: allowed scalars x, y and z");
  expect_ply_error(
      kAscii + "element vertex 0\n" + kXyz + "element face 0\nproperty list uchar float vertex_index\nend_header\n",
      ":7: element face lacks its corners: allowed a list of integers vertex_indices or vertex_index");
}

TEST(Ply, AsciiDataErrors) {
  expect_ply_error(kHeader + kSquare + "4 0 1 2 4\n", ":14: vertex index '4' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "4 0 1 -1 2\n", ":14: vertex index '-1' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "4 0 1 2 nan\n", ":14: vertex index 'nan' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "3 0 1.5 2\n", ":14: vertex index '1.5' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "4 0 1 2\n", ":14: list length '4' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "4 10 11 2\n", ":14: vertex index '10' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "2 0 0001\n", ":14: number of corners '2' is too small: allowed 3 or more");
  expect_ply_error(kHeader + kSquare + "-3 0 1 2\n", ":14: list length '-3' is out of range: allowed 0 to 3");
  expect_ply_error(kHeader + kSquare + "3 0 1 2 3\n",
                   ":14: value '3' is one too many in its row: allowed as many as the header declares");
  expect_ply_error(kHeader + kSquare + "3 0 1 2\n3 0 2 3\n",
                   ":15: the file has data after the last element: allowed as many rows as the header declares");
  expect_ply_error(kHeader + "0 0 0\n1 0\n", ":3: element vertex with 4 rows is larger than the file: allowed 1 rows");
  expect_ply_error(kHeader + "0 0 0\n1 0\n1.00 1.00 0\n0 1 0\n3 0 1 2\n",
                   ":11: a row has too few values: allowed as many as the header declares");
  expect_ply_error(kHeader + "0 0 0\n1 zero 0\n1 1 0\n0 1 0\n3 0 1 2\n",
                   ":11: value 'zero' is no number: allowed a number such as -1.5e-3");
  expect_ply_error(kHeader + "0 0 0\n1.000 0 0\n1 1 0\n0 1 00\n",
                   ":7: element face with 1 rows is larger than the file: allowed 0 rows");
}

// Declared sizes are never trusted: nothing is allocated for rows that cannot be there.
TEST(Ply, LyingSizes) {
  for (const char* count : {"4294967294", "1000000000"}) {
    std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    file.append(count).append("\n").append(kXyz).append("element face 0\n").append(kFace).append("abc");
    std::string message = ":3: element vertex with ";
    expect_ply_error(file, message.append(count).append(" rows is larger than the file: allowed 0 rows"));
  }
  std::string header = kAscii + "element vertex 4294967296\n" + kXyz + "element face 0\n" + kFace;
  expect_ply_error(header, ":3: number of vertices 4294967296 is too large: allowed 4294967294");
  header = kAscii + "element vertex 0\n" + kXyz + "element face 18446744073709551615\n" + kFace;
  expect_ply_error(header, ":7: element face with 18446744073709551615 rows is larger than the file: allowed 0 rows");
  header = kAscii + "element vertex 18446744073709551616\n";
  expect_ply_error(header,
                   ":3: element line 'element vertex 18446744073709551616' is wrong: allowed element NAME COUNT");
}

TEST(Ply, BinaryDataErrors) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + kXyz +
                       "element face 1\nproperty list uint int vertex_indices\nend_header\n";
  auto floats = [](int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i) bytes += bytes_of(i == 3 || i == 7 ? 1.0f : 0.0f, std::endian::little);
    return bytes;
  };
  auto ints = [](std::initializer_list<uint32_t> values) {
    std::string bytes;
    for (uint32_t value : values) bytes += bytes_of(value, std::endian::little);
    return bytes;
  };
  std::string data = header + floats(9);
  size_t start = header.size() + 36;
  EXPECT_EQ(read_ply_bytes(data + ints({3, 0, 1, 2})).indices, (Indices{0, 1, 2}));
  EXPECT_EQ(read_ply_bytes(data + ints({3, 0, 1, 2}) + "\r\n").indices, (Indices{0, 1, 2}));
  expect_ply_error(data + ints({3, 0, 1, 3}), std::string(": byte ") + std::to_string(start + 12) +
                                                  ": vertex index '3' is out of range: allowed 0 to 2");
  expect_ply_error(
      data + ints({0xFFFFFFFF, 0, 1, 2}),
      std::string(": byte ") + std::to_string(start) + ": list length '4294967295' is out of range: allowed 0 to 3");
  expect_ply_error(data + ints({2, 0, 1, 2}), std::string(": byte ") + std::to_string(start) +
                                                  ": number of corners '2' is too small: allowed 3 or more");
  expect_ply_error(data + ints({3, 0, 1, 2, 3}),
                   std::string(": byte ") + std::to_string(start + 16) +
                       ": the file has data after the last element: allowed as many rows as the header declares");
  expect_ply_error(data + ints({3, 0, 1}), ":7: element face with 1 rows is larger than the file: allowed 0 rows");
}

TEST(Ply, TruncationAnywhereIsAnError) {
  for (const std::string& whole : {binary_square(std::endian::little), kHeader + kSquare + "4 0 1 2 3"}) {
    ASSERT_NO_THROW(read_ply_bytes(whole));
    for (size_t size = 0; size < whole.size(); ++size) {
      EXPECT_THROW(read_ply_bytes(whole.substr(0, size)), ReadError) << size;
    }
  }
}

TEST(Ply, EveryByteReplaced) {
  for (const std::string& whole :
       {binary_square(std::endian::little), binary_square(std::endian::big), kHeader + kSquare + "4 0 1 2 3"}) {
    survive_sweeps(whole, [](const std::string& bytes) { return read_ply_bytes(bytes); });
  }
}

// A file is read through a window; rows across its edges must come out the same.
TEST(Ply, FileEqualsMemory) {
  std::string file =
      "ply\nformat binary_big_endian 1.0\nelement vertex 100000\n" + kXyz + "element face 99998\n" + kFace;
  for (int i = 0; i < 300000; ++i) file += bytes_of(static_cast<float>((i % 1009) * (i % 757)), std::endian::big);
  for (int i = 0; i < 99998; ++i) {
    file += '\x03';
    for (int j = 0; j < 3; ++j) file += bytes_of(int32_t{i + j}, std::endian::big);
  }
  auto path = std::filesystem::temp_directory_path() /
              (std::string("accuray_ply_test_") + std::to_string(std::random_device{}()) + ".ply");
  std::ofstream(path, std::ios::binary) << file;
  MeshData from_file = read_ply(path.string()), from_memory = read_ply_bytes(file);
  std::filesystem::remove(path);
  expect_valid(from_file);
  EXPECT_EQ(from_file.report.triangles_read, 99998u);
  EXPECT_EQ(from_file.positions, from_memory.positions);
  EXPECT_EQ(from_file.indices, from_memory.indices);
}

TEST(Ply, Mutants) {
  const std::vector<std::string> seeds = {kHeader + kSquare + "4 0 1 2 3\n", binary_square(std::endian::little),
                                          binary_square(std::endian::big, "\r\n")};
  const std::vector<std::string> tokens = {"4294967295",
                                           "nan",
                                           "-1",
                                           "double",
                                           "list ",
                                           "uchar",
                                           "\n",
                                           " ",
                                           "\xff\xff\xff\xff",
                                           "element vertex 3\n",
                                           "property int k\n",
                                           "end_header\n",
                                           "inf",
                                           "1e99"};
  survive_mutants(seeds, tokens, 6000, [](const std::string& bytes) { return read_ply_bytes(bytes); });
}

}  // namespace
}  // namespace accuray::mesh
