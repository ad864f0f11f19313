// What a shape of body is to a scene and its baker: its keys, mesh, anchors, normals, curvature, presses and elements.
// One file beside config/body/shape/box.cpp holds the card of a shape, NAME_body, or of a few that are made alike; the
// table PALPATE_BODY_SHAPES (config/scene/choices.h) joins them. The tests run over all cards.
#pragma once

#include <span>
#include <vector>

#include "config/body/anchors.h"
#include "config/fem/axisymmetric_press.h"
#include "config/fem/material.h"
#include "config/scene/card.h"

namespace palpate {

struct BodyCurvature {
  double first_1_per_m = 0, second_1_per_m = 0;
};

struct BodyCard {
  const char* meaning;
  std::span<const CardKey> keys;                // of [body]; others have no effect
  Refusal (*check)(const BodyDesc&) = nullptr;  // rules between its keys
  // Closed surface. `label` becomes what messages about it begin with.
  SurfaceMesh (*make)(const SceneDesc&, std::string& label, std::vector<std::string>& warnings);
  // Exact anchors; nullptr: they are found on the mesh.
  std::vector<AnchorPoint> (*anchors)(const BodyDesc&) = nullptr;
  // Exact outward normal at point `p` of a facet of normal `face`, of a body `height_m` high; nullptr: from the mesh.
  Vec3 (*normal)(const BodyDesc&, Vec3 p, Vec3 face, double height_m) = nullptr;
  // Elastic: which part of the surface a facet about `middle` is of, from 1, 0: of none; nullptr: it has no parts. A
  // piece of the tool touches each part in one place, and what is of none in no place. Parts meet nowhere.
  int (*part)(Vec3 middle, Vec3 face) = nullptr;
  // Principal curvatures where a tip touches, the same everywhere (`layer`: pressed as a layer); nullptr: it has none.
  BodyCurvature (*curvature)(const BodyDesc&, bool layer) = nullptr;
  // The body of revolution that stands for it in presses by finite elements, shape alone; false or nullptr: none does.
  bool (*press)(const BodyDesc&, double base_m, fem::PressBody&) = nullptr;
  // Height between flat faces, where it may be pressed as a layer; nullptr: it has none.
  double (*layer_m)(const BodyDesc&) = nullptr;
  // Tetrahedra made without the mesh generator, about `edge_m` long; nullptr: generated within the surface.
  TetMesh (*tets)(const SceneDesc&, std::vector<std::string>& warnings) = nullptr;
  bool own_tets = false;                           // their length is not the scene's to say
  Supports (*supports)(const TetMesh&) = nullptr;  // what is held, where that is not the base
};

const BodyCard& card_of(BodyShape shape);

// Anchors of parametric shapes (anchors_exact.cpp): ends of the axes of an ellipsoid, corners of a box, four points of
// each notable circle of a surface of revolution; on bodies with a hole the same for outer and inner surface.
std::vector<AnchorPoint> axis_end_anchors(Vec3 half_axes_m);
std::vector<AnchorPoint> box_corner_anchors(Vec3 size_m);
std::vector<AnchorPoint> cylinder_anchors(double radius_m, double height_m);
std::vector<AnchorPoint> revolution_anchors(const std::vector<ProfilePoint>& profile);
std::vector<AnchorPoint> half_shell_anchors(const BodyDesc& body);
std::vector<AnchorPoint> ring_anchors(const BodyDesc& body);
std::vector<AnchorPoint> hollow_cylinder_anchors(const BodyDesc& body);

// Outwards at a place `p` from an ellipsoid's middle, not unit.
inline Vec3 out_of_ellipsoid(Vec3 half_axes_m, Vec3 p) {
  const Vec3 h = half_axes_m;
  return {p.x / (h.x * h.x), p.y / (h.y * h.y), p.z / (h.z * h.z)};
}

// Refuses the one of the three axes that a shape does not have.
Refusal axis_other_than(const BodyDesc& body, BodyAxis refused);
// A wall must leave a hole in `room_m`.
Refusal wall_within(const BodyDesc& body, double room_m);
// Path of the file that body.mesh names.
std::string body_file(const SceneDesc& scene);

}  // namespace palpate
