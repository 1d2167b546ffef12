#pragma once
/// Functions that build parts of scenes in a few lines of code, for studies and tests, and that convert a scene to
/// other units.
#include <string>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Diagonal section [N, N m^2]; mass per length [kg/m] and rotary inertia [kg m] about the three axes where given.
scene::Section make_section(const std::string& name, double EA, double GA2, double GA3, double GJ, double EI2,
                            double EI3);
void set_mass(scene::Section& section, double mass, double rotary_1, double rotary_2, double rotary_3);

scene::Node make_node(const std::string& name, const Vec3& position);
/// Straight beam, with section axis 2 along y.
scene::Beam make_beam(const std::string& name, const std::string& section, const std::string& start,
                      const std::string& end, int elements, int order);
/// Joint that fixes a node or body to the ground at the origin.
scene::Joint make_weld(const std::string& name, const std::string& node);
/// Joint between two parts (empty name: the ground); the joint frame has the pose `offset` in each.
scene::Joint make_joint(const std::string& name, scene::JointKind kind, const std::string& first,
                        const Vec3& first_offset, const std::string& second, const Vec3& second_offset);
/// Body with inertia about its centre, which is its reference point.
scene::Body make_body(const std::string& name, double mass, const Vec3& inertia, const Vec3& position);
/// Coupling between the origins of two parts (empty name: the ground); the first of its numbers, the others are 0.
scene::Coupling make_coupling(const CouplingKind& kind, const std::string& name, const std::string& first,
                              const std::string& second, std::vector<double> values = {});
scene::PointLoad make_load(const std::string& node, const Vec3& force, const Vec3& moment = Vec3::zero(),
                           scene::LoadAxes axes = scene::LoadAxes::space);
scene::Sensor make_point_sensor(const std::string& name, scene::SensorKind kind, const std::string& node);
scene::Sensor make_section_sensor(const std::string& name, const std::string& beam, double station);
scene::Sensor make_joint_sensor(const std::string& name, const std::string& joint,
                                scene::SensorKind kind = scene::SensorKind::joint_reaction);

/// Straight static cantilever from the origin along x, axis 2 along y: nodes "root" and "tip", beam "beam", joint
/// "clamp", sensors "tip" (position), "turn" (rotation), "clamp" (reaction).
scene::Scene make_cantilever(const scene::Section& section, double length, int elements, int order);

/// N windows of planar four-bars side by side, each bar 1 kg and 1 m, gravity along -y, upright, the upper corners at
/// 1 m/s along x (IFToMM benchmark A02): 2 N + 1 bodies, 3 N + 1 hinges about z, whose rows in part depend on each
/// other. Sensor "B0": the first corner.
scene::Scene make_four_bars(int windows);

/// Multiplies all masses and, to keep the frequencies, all stiffnesses of beams and joints by `factor`. Forces grow by
/// this factor and motions do not change. Efforts in joints given by laws are not supported: throws
/// std::invalid_argument.
void scale_masses(scene::Scene& scene, double factor);

/// Millimetres and tonnes: forces stay newtons, moments become N mm. Scenes of bodies, beams, joints without forces,
/// gravity and initial velocities; others throw std::invalid_argument.
void to_millimetres(scene::Scene& scene);

/// Factor by which a column of the history grows when lengths grow by `length` and forces by `force`: moments and
/// energies grow by their product, angles do not change.
double column_factor(const scene::Scene& scene, const std::string& column, double length, double force);

}  // namespace bough::scene
