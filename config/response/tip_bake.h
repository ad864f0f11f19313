// Tip laws and factor tables of a scene's tool: from shapes, material and layer to the image.
#pragma once

#include <string>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/response/layer_contact.h"
#include "config/scene/scene.h"

namespace palpate {

// A law before it is written: everything in SI.
struct TipDesc {
  Indenter indenter;
  double modulus_Pa = 0;   // E* = E/(1 - nu^2)
  ElasticLayer layer;      // thickness 0: half space
  double depth_max_m = 0;  // of the local indentation
  double c0_m_per_N = 0, c1_m_per_N2 = 0;
};

// The law and, where its factor is not 1, the table appended to `factor` (TipLaw::first_factor points at it). Throws
// ConfigError when the stiffness of the whole law, far field included, is not positive everywhere in its range.
TipLaw make_tip_law(const TipDesc& tip, std::vector<FactorKnot>& factor);

// Shape of a piece's tip.
Indenter tip_indenter(const PieceDesc& piece);

// Coefficient of the half-space law.
double tip_coefficient(const Indenter& indenter, double modulus_Pa);

struct ResponseReport {
  std::vector<std::string> tip;  // lines: two per piece, or what was pressed
  double slack_m = 0;            // largest distance between facets and smooth surface
  std::int64_t curves = 0;       // distinct force curves
  std::int64_t knots = 0;        // of each
  double bytes_per_vertex = 0;   // of the tables: curves, knots and the index, over the vertices
};

// Fills what the scene's response law needs in `image`, whose surface and tool are complete; for point laws on the
// smooth surface, its normals.
void bake_response(const SceneDesc& scene, ImageContents& image, ResponseReport& report,
                   std::vector<std::string>& warnings);

}  // namespace palpate
