// The CSV files of the original iPad program, ProbeDeformer: its probes are taken over.
#pragma once

#include <string_view>
#include <vector>

#include "model/document.h"
#include "model/error.h"

namespace probewarp {

/// The probes of a CSV with a line "#vertices ...", its rows (passed over), a line "#probes ..." and a row
/// ix,iy,itheta,x,y,theta,radius a probe: origin at the centre of the picture scaled to 1024 along its longer
/// side, y up, radians anticlockwise. They fit the document's picture; ids begin after those of `document`.
/// It may have gone through a spreadsheet: UTF-8 or UTF-16 with any line ends; commas, semicolons, tabs or
/// what a first line "sep=" says between the columns; decimal points or commas (between commas only in
/// quotes); quotes, signs, spaces, empty columns behind the seventh, empty rows, a row that names the
/// columns. Throws Error: a clause that names the line.
std::vector<Probe> decode_probes_csv(std::string_view text, const Document& document);

}  // namespace probewarp
