#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/device/instruction_set.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/particles/grain.h"
#include "shallow_sand/sim/body_windows.h"
#include "shallow_sand/sim/simulator.h"
#include "shallow_sand/sim/step_run.h"
#include "shallow_sand/solver/change_sand.h"
#include "shallow_sand/solver/cover.h"
#include "shallow_sand/solver/sand_constants.h"
#include "shallow_sand/solver/step.h"

namespace shallow_sand {

/// The sand where it lies, a value a cell each, laid out as in Fields; those of loads and cover are null as
/// long as there are no bodies.
struct SandView {
  const float* depth;
  const float* momentum_x;
  const float* momentum_y;
  const float* load;
  const float* load_momentum_x;
  const float* load_momentum_y;
  /// Where it is Cover::touching, the six above tell of the load as the sand and the other way round; may be
  /// null.
  const Cover* cover;
};

/// The fields on their backend, and what computes with them; it knows no motion.
class Engine {
 public:
  virtual ~Engine() = default;

  /// Bodies are numbered from 0.
  virtual void addBody(const DistanceField& field) = 0;
  /// Frees what a body took; it is not placed again, and its number not used again.
  virtual void removeBody(std::size_t body) = 0;
  /// Pours are numbered from 0.
  virtual void addPour(const LocalRegion& region, const PourTimes& times) = 0;

  /// Bodies stand here now, and no others: the sand makes way, as far as in so many steps.
  virtual void placeBodies(const std::vector<PlacedBody>& bodies, int steps) = 0;
  /// Sand will fall on this region: bodies over it are not left out the next time that bodies are placed.
  virtual void expectSand(const LocalRegion& region) = 0;
  /// Starts to take the steps of a run, in which bodies are where these placements say. The GPU goes on by
  /// itself: no other function may be called before finish() but collectFields().
  virtual void start(const StepRun& run, std::vector<Placement> placements) = 0;
  /// Waits for the run that was started. Returns where it came to.
  virtual StepRun finish() = 0;
  /// From now on the sand is of this kind, in this gravity: all of it wakes up. The material's lists are as
  /// long as those that the engine was made with.
  virtual void setSand(const SandConstants& sand, const LocalMaterialFields& material) = 0;
  /// Changes the sand at once. Returns by how much it grew [m³].
  virtual double edit(const LocalRegion& region, EditOperation operation, float value) = 0;
  /// The same for the whole map, with a value [m] for each cell; NaN where the sand stays as it is.
  virtual double edit(EditOperation operation, const std::vector<float>& values) = 0;

  virtual Fields fields() = 0;
  /// The fields without a copy where the host can read them, else a request and its answer; valid until
  /// anything else is asked for.
  virtual SandView view() = 0;
  /// The fields as they are now leave for the host, which has them when they are collected; a run may be
  /// started in between.
  virtual void requestFields() = 0;
  /// The fields that were requested the last time.
  virtual const Fields& collectFields() = 0;
  /// Windows that hold all cells in which the fields that were collected differ from those that were when
  /// this was asked the last time.
  virtual std::vector<Window> takeChanges() = 0;
  virtual double poured() const = 0;  ///< by pours and edits [m³]
  virtual double left() const = 0;    ///< over open edges, by pours and edits [m³]
  /// Sand inside of these bodies. [m³]
  virtual double overlap(const std::vector<PlacedBody>& bodies) = 0;
  /// What each body that there ever was has given to sand that made way for it, since the start or since the
  /// sand was restored; 0 for those that were removed. [m⁴/s]
  virtual std::vector<Eigen::Vector2d> givenMomentum() const = 0;

  /// Grains go on with the velocities that the sand has now, as in this time [s]. Moves are numbered from 1.
  virtual void moveGrains(float duration, std::uint32_t number) = 0;
  virtual std::vector<Grain> grains() = 0;
  virtual void setGrains(const std::vector<Grain>& grains) = 0;

  virtual ContactSnapshot contacts() const = 0;
  /// Goes on from fields and contacts that were taken from an engine like this one.
  virtual void restore(const Fields& fields, const ContactSnapshot& contacts) = 0;
};

/// An engine that takes its steps one by one, at the host's command.
class SteppedEngine : public Engine {
 public:
  /// Computes a step of dt [s]. Returns the largest speed that it had to follow (Eq. 14, 34), that of bodies
  /// in the sand included [m/s]: if dt was too long for it, attempt again.
  virtual float attempt(float dt) = 0;
  /// The last attempt becomes the state, and sand on bodies flows for as long. Returns how many cells the
  /// attempt computed.
  virtual long long accept() = 0;
  /// Adds this volume [m³] through a pour; takes it away if it is negative, as far as there is some.
  virtual void pour(std::size_t number, double volume) = 0;
};

/// Every backend's engine starts from the same values. `fields` are those of a valid state.
struct EngineStart {
  Grid grid;
  SandConstants sand;
  OpenEdges open;
  Fields fields;
  LocalMaterialFields material;
  bool with_slopes;   ///< minmod reconstruction
  bool displacement;  ///< see SimulatorParameters
  std::optional<GrainParameters> grains{};
};

/// @param sleeping whether cells that cannot move are left out
std::unique_ptr<SteppedEngine> makeHostEngine(const EngineStart& start, int threads, bool sleeping,
                                              InstructionSet instructions);

#ifdef SHALLOW_SAND_WITH_CUDA
/// @param steps_at_once after which the GPU is free for others for a moment, however long the run
/// @throws std::runtime_error with CUDA's own words
std::unique_ptr<Engine> makeCudaEngine(const EngineStart& start, std::uint64_t steps_at_once);
/// So many that a GPU which also shows a desktop is not taken from it for long.
std::uint64_t cudaStepsAtOnce(const Grid& grid);
/// Why CUDA cannot be used on this machine; empty if it can.
std::string cudaUnavailable();
/// Name of the current CUDA device.
std::string cudaDeviceName();
#endif

}  // namespace shallow_sand
