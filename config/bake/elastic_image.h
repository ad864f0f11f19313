// An elastic body for the image: modes, soft energy and self terms (config/elastic), shown at the surface's vertices.
#pragma once

#include <cstdint>
#include <memory>

#include "config/bake/compile.h"
#include "config/fem/tet_mesh.h"

namespace palpate {

// What all choices of modes share, made once: elements, factor, a pool of modes, samples.
class ElasticBake {
 public:
  // The surface in `image` is complete. Up to `modes` modes can be written. `jobs`: threads (config/parallel.h). Throws
  // ConfigError.
  ElasticBake(const SceneDesc& scene, const ImageContents& image, int modes, std::vector<std::string>& warnings,
              unsigned jobs);
  ~ElasticBake();
  const TetMesh& mesh() const;
  // What a factor of the body's stiffness takes (fem::SupernodalFactor::multiplications).
  double factor_multiplications() const;
  // What the body looks like when pressed: for images that are kept. No tick of a trial reads it.
  enum class Drawn : std::uint8_t { kLeftOut, kWritten };
  // Fills the elastic arrays and parameters. `add_c_mpN` goes to every self term.
  ElasticReport write(int soft, int linear, double add_c_mpN, ImageContents& image, Drawn drawn) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
