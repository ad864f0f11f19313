// Keys of [body] and of the tables below it.
#include "config/scene/schema_keys.h"

namespace palpate::schema {

namespace {

const KeySpec kBody[] = {
    choice<&BodyDesc::shape>("shape", "kind of body, see the shapes below", true),
    list<&BodyDesc::half_axes_m>(kVec3, "half_axes_mm", 1, 5000, kMilli, "half axes along x, y, z"),
    number<&BodyDesc::radius_m>("radius_mm", 1, 5000, kMilli, "radius, the outer one where there are two"),
    number<&BodyDesc::height_m>("height_mm", 1, 10000, kMilli, "length along the axis"),
    list<&BodyDesc::size_m>(kVec3, "size_mm", 1, 10000, kMilli, "sides along x, y, z"),
    number<&BodyDesc::width_m>("width_mm", 1, 10000, kMilli, "width along x"),
    number<&BodyDesc::wall_m>("wall_mm", 0.1, 5000, kMilli, "wall, or thickness of a round section"),
    number<&BodyDesc::e1>("e1", 0.2, 1.8, 1, "exponent seen from the side: 0.2 square, 1 round, 1.8 pointed"),
    number<&BodyDesc::e2>("e2", 0.2, 1.8, 1, "exponent seen from above"),
    choice<&BodyDesc::axis>("axis", "direction of the body's axis: y is up"),
    choice<&BodyDesc::pattern>("pattern",
                               "how a sphere or ellipsoid is cut: geodesic, triangles of about one size; rings, "
                               "parallels and meridians with poles along y, 4 n (n - 1) of them"),
    list<&BodyDesc::profile>(KeyKind::kPairs, "profile_mm", -10000, 10000, kMilli,
                             "points [radius, height] from bottom to top; turns above 35 degrees stay "
                             "sharp, the rest is smoothed; open ends are closed by discs"),
    text<&BodyDesc::mesh>("mesh", 4096, "file, relative to the scene file; y is up"),
    number<&BodyDesc::scale>("scale", 1e-9, 1e6, 1, "metres per unit of the file"),
    boolean<&BodyDesc::fix_orientation>("fix_orientation", "turn triangles that face inwards"),
    integer<&BodyDesc::triangles>("triangles", kFewestTriangles, kMostTriangles,
                                  "about this many triangles; the tick's cost hardly depends on it"),
    list<&BodyDesc::position_m>(kVec3, "position_mm", -1e4, 1e4, kMilli,
                                "where the origin of the shape or file goes in the world"),
    list<&BodyDesc::rotation_rad>(kVec3, "rotation_deg", -360, 360, kDegree,
                                  "rotation vector (axis times angle) about that origin, before it goes there"),
};
const KeySpec kFem[] = {
    choice<&FemDesc::order>("order",
                            "quadratic: 10-node tetrahedra; linear: 4-node ones, 12 to 22 % too stiff in bending; "
                            "mixed: quadratic in a zone, linear elsewhere, with transition elements between"),
    list<&FemDesc::zone_from_m>(kVec3, "zone_from_mm", -10000, 10000, kMilli,
                                "mixed: lowest corner of the box, in the world, where elements are quadratic"),
    list<&FemDesc::zone_to_m>(kVec3, "zone_to_mm", -10000, 10000, kMilli, "mixed: its highest corner"),
    integer<&FemDesc::zone_layers>("zone_layers", 1, 10,
                                   "mixed: layers of quadratic elements around the nodes in the box"),
    number_or_auto<&FemDesc::edge_m>(
        "edge_mm", 0.01, 1000, kMilli,
        "about this long an edge of a tetrahedron; auto: an eighth of the largest extent, and "
        "where an elastic body's volume by its surface (half a wall) is less, that; "
        "box: an even number along x or z makes its mesh symmetric there; "
        "clip, tets: the mesh has its own"),
    integer<&FemDesc::level>("level", 1, 3, "clip: fineness of its mesh; 1 has 717 nodes"),
    choice<&FemDesc::precision>("precision",
                                "numbers of the compliance table; auto: single where its force error is below 1e-4"),
    integer<&FemDesc::strain_gauges>("strain_gauges", 0, kMaxStrainGauges, "points whose strain is watched every tick"),
};
const KeySpec kElastic[] = {
    integer<&ElasticDesc::soft>("soft_modes", 0, kMaxSoftModes,
                                "softest modes of the surface, with their energy to the fourth order; raised where it "
                                "would part a symmetric pair; 0: the fewest of 1, 2, 4, 8 that meet check_error"),
    integer<&ElasticDesc::linear>("linear_modes", 0, kMaxLinearModes,
                                  "further modes, linear, through which contact regions feel one another"),
    integer<&ElasticDesc::check_presses>(
        "check_presses", -1, 16,
        "places where a ball as large as the tool's tip is pressed into large-strain elements to check the modes, up "
        "to contact.max_depth_mm, 0.45 of what lies above a support or three times device.force_max_N; 10 to 25 s "
        "each, minutes where the body has tens of thousands of nodes; -1: 5 where soft_modes = 0, or as many as are "
        "done "
        "in ten minutes of one processor, else none"),
    number<&ElasticDesc::check_error>("check_error", 1e-4, 1, 1, "relative error of the force that they may show"),
};
const KeySpec kMaterial[] = {
    number<&MaterialDesc::youngs_modulus_Pa>("youngs_modulus_Pa", 1, 1e13, 1, "Young's modulus E"),
    number<&MaterialDesc::poisson_ratio>("poisson_ratio", -0.999, 1, 1,
                                         "Poisson's ratio nu; at most 0.5 (larger is thermodynamically impossible)"),
    number<&MaterialDesc::density_kg_per_m3>("density_kg_per_m3", 1, 1e5, 1, "density rho"),
    list<&MaterialDesc::relaxation_share>(
        kVec3, "relaxation_share", 0, 0.95, 1,
        "parts of the force that relax when the body is held, one for each term (0: none); below 0.95 together"),
    list<&MaterialDesc::relaxation_s>(kVec3, "relaxation_s", 1e-3, 1e4, 1, "and with which time constants"),
    number<&MaterialDesc::lost_share>("lost_share", 0, 0.5, 1,
                                      "part of a press's work that its release does not give back, however slow"),
    boolean<&MaterialDesc::legacy_paper_material>(
        "legacy_paper_material", "accept the nu = 1.0 printed by Cui & Xiao 2008 and use 0.47 instead, with a warning"),
};
const KeySpec kMaterialRegion[] = {
    choice<&MaterialRegionDesc::region>("region",
                                        "where the material is: in a box or a ball of the world, or in the elements of "
                                        "a physical group of a .msh file (shape = \"tets\")",
                                        true),
    list<&MaterialRegionDesc::from_m>(kVec3, "from_mm", -10000, 10000, kMilli, "box: its lowest corner"),
    list<&MaterialRegionDesc::to_m>(kVec3, "to_mm", -10000, 10000, kMilli, "box: its highest corner"),
    list<&MaterialRegionDesc::centre_m>(kVec3, "centre_mm", -10000, 10000, kMilli, "ball: its centre"),
    number<&MaterialRegionDesc::radius_m>("radius_mm", 0.001, 10000, kMilli, "ball: its radius"),
    text<&MaterialRegionDesc::group>("group", 127, "group: its name, or its number in quotes"),
    number<&MaterialRegionDesc::youngs_modulus_Pa>("youngs_modulus_Pa", 1, 1e13, 1, "Young's modulus E there", true),
    number<&MaterialRegionDesc::poisson_ratio>("poisson_ratio", -0.999, 0.4999, 1,
                                               "Poisson's ratio nu there; left out: that of body.material"),
};
const KeySpec kFixed[] = {
    choice<&FixedDesc::region>("region",
                               "what of the body is held: its base; what lies in a box or a ball; a patch of its "
                               "surface about the place nearest to a point; the surface between listed vertices. With "
                               "tool points (base, box, ball) the anchors there stand still, with finite elements the "
                               "nodes"),
    number<&FixedDesc::base_height_m>("base_height_mm", 0, 10000, kMilli,
                                      "base: everything of the body up to this height above its lowest point"),
    list<&FixedDesc::from_m>(kVec3, "from_mm", -10000, 10000, kMilli, "box: its lowest corner"),
    list<&FixedDesc::to_m>(kVec3, "to_mm", -10000, 10000, kMilli, "box: its highest corner"),
    list<&FixedDesc::centre_m>(kVec3, "centre_mm", -10000, 10000, kMilli,
                               "ball: its centre; patch: the surface nearest to it is the patch's middle"),
    number<&FixedDesc::radius_m>("radius_mm", 0.001, 10000, kMilli,
                                 "ball: its radius; patch: how far the surface is held around its middle"),
    list<&FixedDesc::vertices>(KeyKind::kIntegers, "vertices", 0, 1e9, 1,
                               "vertices: numbers, from 0, of vertices of the body's surface in the order of its file "
                               "(tets: of the surface's nodes); triangles with all three corners listed are held"),
    text<&FixedDesc::vertices_file>("vertices_file", 4096,
                                    "the same numbers in a text file, between blanks, relative to the scene file"),
    choice<&FixedDesc::holds>(
        "holds",
        "components of the displacement that are held; y alone over a flat base is a rigid "
        "plate without friction. Finite elements only. normal: along the surface's own normal, of an elastic "
        "bed only (a stiff one is a plate that slopes or bends)"),
    number<&FixedDesc::stiffness_N_per_m3>(
        "stiffness_N_per_m3", 1, 1e13, 1,
        "pressure of an elastic bed on the surface in the region, per displacement (Winkler's springs; of a layer of "
        "thickness t about E / t); without it the region is held rigidly. contact.backend = \"elastic\" only"),
};

}  // namespace

std::span<const KeySpec> body_keys() { return kBody; }
std::span<const KeySpec> fem_keys() { return kFem; }
std::span<const KeySpec> elastic_keys() { return kElastic; }
std::span<const KeySpec> material_keys() { return kMaterial; }
std::span<const KeySpec> material_region_keys() { return kMaterialRegion; }
std::span<const KeySpec> fixed_keys() { return kFixed; }

}  // namespace palpate::schema
