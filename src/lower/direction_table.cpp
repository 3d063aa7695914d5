#include "lower/direction_table.h"

#include <span>

#include "kernels/math/functions.h"
#include "kernels/math/interval.h"

namespace accuray {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCommonShare = 1.0 / 256.0;

// Appends the running sums of the probabilities of weighted intervals, from 0 to 1; zeros if nothing has a weight.
void append_sums(std::span<const double> weights, std::vector<float>& sums) {
  double total = 0.0;
  double lit = 0.0;
  for (const double w : weights) {
    total += w;
    lit += w > 0.0 ? 1.0 : 0.0;
  }
  double sum = 0.0;
  sums.push_back(0.0f);
  for (const double w : weights) {
    if (w > 0.0) sum += (1.0 - kCommonShare) * (w / total) + kCommonShare / lit;
    sums.push_back(static_cast<float>(sum));
  }
  if (total > 0.0) sums.back() = 1.0f;
}

// A power of two of parts of [0, 1], with some intervals to each.
uint32_t guide_parts(uint32_t intervals) {
  uint32_t parts = 1;
  while (parts * 4 <= intervals) parts *= 2;
  return parts;
}

void append_guide(const float* sums, uint32_t intervals, std::vector<uint32_t>& guide) {
  const uint32_t parts = guide_parts(intervals);
  for (uint32_t k = 0; k <= parts; ++k) {
    guide.push_back(interval_of(sums, intervals, static_cast<float>(k) / static_cast<float>(parts)));
  }
}

template <class T>
Slice<T> stored(const Section& section, std::vector<Section>& bulk) {
  bulk.push_back(section);
  return {0, static_cast<uint32_t>(bulk.size()), static_cast<uint32_t>(section.size / sizeof(T))};
}

}  // namespace

double cell_solid_angle(uint32_t width, uint32_t height, uint32_t row) {
  const double step = kPi / height;
  const double span = sincos(step * row).cos - sincos(step * (row + 1)).cos;
  return 2.0 * kPi * span / width;
}

double mean_of(const RadianceCells& cells) {
  double mean = 0.0;
  for (uint32_t row = 0; row < cells.height; ++row) {
    double sum = 0.0;
    for (uint32_t i = 0; i < cells.width; ++i) {
      sum += static_cast<double>(cells.values[static_cast<size_t>(row) * cells.width + i]);
    }
    mean += sum * cell_solid_angle(cells.width, cells.height, row) / (4.0 * kPi);
  }
  return mean;
}

DirectionTable make_direction_table(const RadianceCells& cells, std::vector<Section>& bulk) {
  return place(direction_sections(cells), bulk);
}

DirectionTable place(const DirectionSections& made, std::vector<Section>& bulk) {
  return {stored<float>(made.rows, bulk),
          stored<float>(made.columns, bulk),
          stored<uint32_t>(made.row_guide, bulk),
          stored<uint32_t>(made.column_guide, bulk),
          made.width,
          made.height,
          guide_parts(made.height),
          guide_parts(made.width)};
}

DirectionSections direction_sections(const RadianceCells& cells) {
  std::vector<float> rows;
  std::vector<float> columns;
  columns.reserve(static_cast<size_t>(cells.width + 1) * cells.height);
  std::vector<double> of_rows;
  std::vector<double> of_cells(cells.width);
  for (uint32_t row = 0; row < cells.height; ++row) {
    double sum = 0.0;
    for (uint32_t i = 0; i < cells.width; ++i) {
      of_cells[i] = static_cast<double>(cells.values[static_cast<size_t>(row) * cells.width + i]);
      sum += of_cells[i];
    }
    append_sums(of_cells, columns);
    of_rows.push_back(sum * cell_solid_angle(cells.width, cells.height, row));
  }
  append_sums(of_rows, rows);
  std::vector<uint32_t> row_guide;
  std::vector<uint32_t> column_guide;
  append_guide(rows.data(), cells.height, row_guide);
  for (size_t row = 0; row < cells.height; ++row) {
    append_guide(columns.data() + row * (cells.width + 1), cells.width, column_guide);
  }
  return {section_of(std::move(rows)),
          section_of(std::move(columns)),
          section_of(std::move(row_guide)),
          section_of(std::move(column_guide)),
          cells.width,
          cells.height};
}

}  // namespace accuray
