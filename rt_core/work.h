// What one tick did, counted where it is done: a few additions per loop, never one per pass. A tick cannot count its
// instructions, but these and their prices (stage_cost.h) tell them within what tests/bench/adversary_work.sh
// holds them to. Thrown away with the Scratch; read by no tick.
#pragma once

#include <cstdint>

namespace palpate {

// X(unit, stage, instructions each, what is counted). Prices: stage_cost.h tells where they come from.
#define PALPATE_WORK_UNITS(X)                                                                  \
  X(other_samples, kSense, 4100, "second hands' samples taken, and their tools predicted")     \
  X(landings, kSense, 1400, "looks for parts that a tool comes to, and those that hold it")    \
  X(joints, kArticulate, 386, "joints of the tool, and links placed")                          \
  X(joint_loads, kArticulate, 75, "loads of pieces taken about a joint")                       \
  X(points, kFindRows, 36, "tool points visited")                                              \
  X(pieces, kFindRows, 300, "pieces placed")                                                   \
  X(looks, kFindRows, 222, "boxes and triangles of the surface looked at")                     \
  X(queries, kFindRows, 730, "points measured on it")                                          \
  X(waiting, kFindRows, 240, "points whose turn did not come")                                 \
  X(feet, kFindRows, 335, "Newton steps towards a smooth foot")                                \
  X(found, kFindRows, 110, "contacts found")                                                   \
  X(pairs, kFindRows, 32, "pairs of contacts compared, and labels changed")                    \
  X(clusters, kFindRows, 480, "clusters given a place")                                        \
  X(recalls, kFindRows, 19, "contacts compared with lost regions")                             \
  X(scans, kFindRows, 26, "tool points looked through for a lost region")                      \
  X(supports, kFindRows, 740, "supports of the overlap test")                                  \
  X(fours, kFindRows, 130, "nodes of a body, four at a time, against a piece")                 \
  X(planes, kFindRows, 10, "planes of hulls against four nodes")                               \
  X(faces, kFindRows, 20, "faces of hulls against those in reach")                             \
  X(near, kFindRows, 220, "of them those in reach")                                            \
  X(near_regions, kFindRows, 85, "of those, regions that may carry them")                      \
  X(rounded, kFindRows, 520, "nodes in reach that stand on a bend")                            \
  X(predicted, kFindRows, 130, "pushes times nodes that they move, eight nodes for one")       \
  X(offered, kFindRows, 22, "places changed among the deepest")                                \
  X(shown, kFindRows, 51, "terms of an elastic body's vertices summed up")                     \
  X(crossed, kFindRows, 210, "facets walked over below a tip")                                 \
  X(foot_steps, kFindRows, 315, "Newton steps towards a foot on it")                           \
  X(placed, kFindRows, 4050, "tips whose pull on it is told")                                  \
  X(shapes, kFindRows, 6, "terms of that pull")                                                \
  X(lines, kFindRows, 600, "of these tips capsules and plates")                                \
  X(part_looks, kFindRows, 335, "facets of its parts looked at")                               \
  X(part_visits, kFindRows, 2250, "tips placed on a part")                                     \
  X(soft_pairs, kFindRows, 6.7, "entries of its energy summed up")                             \
  X(rows, kSolve, 215, "rows in contact")                                                      \
  X(regions, kSolve, 1960, "their regions")                                                    \
  X(spring_laws, kSolve, 68, "laws of points evaluated")                                       \
  X(tip_laws, kSolve, 158, "laws of tips evaluated")                                           \
  X(standing, kSolve, 720, "beams of skeletons that later regions' depths stand on")           \
  X(region_pairs, kSolve, 8, "pairs of regions coupled, per evaluation")                       \
  X(region_cubes, kSolve, 1.2, "entries eliminated by the regions' Newton steps")              \
  X(evaluations, kSolve, 243, "times all coupled regions were evaluated, and their steps")     \
  X(linearised, kSolve, 2300, "regions of an elastic body linearised")                         \
  X(mode_cubes, kSolve, 44, "entries eliminated of its modes' stiffness")                      \
  X(linked, kSolve, 29, "its modes between rows of regions")                                   \
  X(soft_pairs_again, kSolve, 7.2, "entries of its energy summed up")                          \
  X(gathered, kSolve, 4, "vectors of eight gathered from a body's compliance")                 \
  X(vectors, kSolve, 5.6, "vectors of four or eight multiplied and added")                     \
  X(exact, kSolve, 42, "entries of a compliance in double precision")                          \
  X(frames, kSolve, 310, "frames of nodes")                                                    \
  X(visits, kSolve, 25, "nodes visited by friction")                                           \
  X(rubbing, kSolve, 450, "of them those that push")                                           \
  X(pivots, kSolve, 3700, "active sets tried")                                                 \
  X(slid, kAccount, 205, "rows accounted for")                                                 \
  X(rubbed, kAccount, 910, "regions rubbed")                                                   \
  X(beams, kAccount, 200, "beams of skeletons")                                                \
  X(carried, kAccount, 60, "beams times regions they carry to")                                \
  X(grouped, kAccount, 1550, "clusters of pushing nodes given a place")                        \
  X(joined, kAccount, 54, "pairs of pushing nodes compared, and places recalled")              \
  X(summed, kAccount, 10, "vectors multiplied and added")                                      \
  X(told, kAccount, 4.5, "entries of a tangent that is told to a device by itself")            \
  X(landings_again, kAccount, 890, "the same where it is balanced")                            \
  X(other_balances, kAccount, 4500, "second hands' tools balanced")                            \
  X(felt, kSafety, 2600, "stiffnesses that hands feel, found for the device or its smoothing") \
  X(other_outputs, kSafety, 4700, "second hands' wrenches limited")

struct Work {
#define PALPATE_UNIT(unit, stage, price, what) std::int32_t unit = 0;
  PALPATE_WORK_UNITS(PALPATE_UNIT)
#undef PALPATE_UNIT
};

}  // namespace palpate
