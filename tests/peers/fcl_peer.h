// The contact query of the Flexible Collision Library (FCL; Pan, Chitta & Manocha 2012): every piece of the tool
// against the body's surface, each in a hierarchy of oriented boxes. It finds contacts; it knows no forces.
#pragma once

#include <memory>
#include <span>

#include "config/body/mesh.h"
#include "rt_core/vec.h"

namespace palpate::peers {

class FclPeer {
 public:
  // `pieces`: closed surfaces in the frames of the pieces.
  FclPeer(const SurfaceMesh& body, std::span<const SurfaceMesh> pieces);
  ~FclPeer();
  FclPeer(const FclPeer&) = delete;
  FclPeer& operator=(const FclPeer&) = delete;
  // Contacts of all pieces where they stand, at most `most` a piece.
  std::size_t contacts(std::span<const Pose> piece_w, std::size_t most);

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

}  // namespace palpate::peers
