// Tables by which infinite lights draw directions: kernels/light/directions.h reads them.
#pragma once

#include <vector>

#include "kernels/light/directions.h"
#include "lower/block.h"

namespace accuray {

// Mean radiance of each of width x height cells of an equirectangular map, row by row from the top, in any unit.
struct RadianceCells {
  std::vector<float> values;
  uint32_t width, height;
};

// Solid angle of one cell of a row, sr.
double cell_solid_angle(uint32_t width, uint32_t height, uint32_t row);

// Mean over all directions.
double mean_of(const RadianceCells& cells);

// The density in proportion to the cells' radiance, in sections of its own. Cells that are not black keep a 256th of
// the mean probability besides: the running sums, of single precision, would lose them beside a sun.
DirectionTable make_direction_table(const RadianceCells& cells, std::vector<Section>& bulk);

// The same in two steps: the sections, which many scenes may hold, and their place in one scene.
struct DirectionSections {
  Section rows, columns, row_guide, column_guide;
  uint32_t width = 0, height = 0;
};
DirectionSections direction_sections(const RadianceCells& cells);
DirectionTable place(const DirectionSections& made, std::vector<Section>& bulk);

}  // namespace accuray
