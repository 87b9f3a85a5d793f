#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/coupling/sand_contact.h"
#include "shallow_sand/device/instruction_set.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/particles/grains.h"
#include "shallow_sand/sim/step_run.h"

namespace shallow_sand {

enum class Backend { automatic, cpu, cuda };

/// "auto", "cpu", "cuda".
std::string toString(Backend backend);
/// @throws InvalidParameter with key `backend`
Backend backendFromString(const std::string& name);

/// What bodies do to sand. All but the first are there to compare with the paper.
enum class Coupling {
  displacement,    ///< it makes way, and gets their velocity
  drag,            ///< it gets their velocity: Eq. 20 to 24 alone
  horizontal_drag  ///< the same without Eq. 21 to 24: bodies only turn about z and move along x and y
};

struct SimulatorParameters {
  GridParameters grid;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< in the grid's frame [m/s²]
  Material material;
  Edges edges;
  SolverParameters solver;
  std::optional<GrainParameters> grains;  ///< none unless given
  Backend backend = Backend::automatic;
  int threads = 0;  ///< of the CPU backend; 0: as many as OpenMP offers
  Coupling coupling = Coupling::displacement;
  /// These two change no bit, only speed; for tests and benchmarks of the CPU backend.
  bool sleeping = true;                        ///< leave out cells that cannot move
  std::optional<InstructionSet> instructions;  ///< the fastest of the machine unless given

  void validate() const;  ///< @throws InvalidParameter
};

/// Where the sand went, summed in double precision. [m³]
struct Ledger {
  double start = 0.0;
  double poured = 0.0;  ///< came through pours and edits
  double left = 0.0;    ///< went over open edges, through pours with a negative rate and edits
  double now = 0.0;
  /// |now − (start + poured − left)| / (start + poured); 0 when there never was sand.
  double error() const;
};

/// What the sand does now.
struct SandFigures {
  Ledger ledger;
  double max_speed = 0.0;        ///< [m/s]
  std::size_t active_cells = 0;  ///< cells whose sand moves
};

/// What the last rays found, one value a cell each; all empty if no body is over the map. A run goes on from
/// it, for what lies on bodies depends on where they were.
struct ContactSnapshot {
  std::vector<Window> windows;   ///< columns that bodies may touch
  std::vector<float> clearance;  ///< depth of sand that fits under the lowest body, infinite without one [m]
  std::vector<float> headroom;  ///< depth of sand that fits between it and the next, infinite without one [m]
  std::vector<float> cover;     ///< Cover of each column, as a number
  std::vector<float> length;    ///< of it within the ground's sand [m]
  std::vector<float> velocity_x;  ///< of the body [m/s]
  std::vector<float> velocity_y;
  std::vector<float> velocity_z;
};

/// Everything that a run needs to go on bit for bit, besides what it was built from: parameters, material,
/// pours, bodies and their motion.
struct Snapshot {
  Fields fields;
  ContactSnapshot contacts;
  bool bodies_cleared = false;  ///< sand was moved out of all bodies that have a pose
  double time = 0.0;            ///< [s]
  double next_step = 0.0;       ///< length that would be tried next [s], may be infinite
  Progress progress;
  Ledger ledger;
  Grains grains;  ///< those that there are; if it has none, grains start anew
};

/// The same sand without bodies: what they held lies on the ground under it.
Snapshot withoutBodies(Snapshot snapshot);

/// The one façade over the solver, its bodies and its backends. Not thread-safe; several may live in one
/// process.
class Simulator {
 public:
  /// `bed` [m] and `depth` [m]: one value a cell, finite, depth not negative. `material` is used where it is
  /// not empty, `parameters.material` elsewhere.
  /// @throws InvalidParameter; std::runtime_error if `backend: cuda` is asked for and there is no such device
  Simulator(const SimulatorParameters& parameters, std::vector<float> bed, std::vector<float> depth,
            const MaterialFields& material = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  const SimulatorParameters& parameters() const;  ///< as they are now
  const Grid& grid() const;
  Backend backend() const;  ///< the one in use: cpu or cuda
  int threads() const;      ///< of the CPU backend; 1 on the GPU
  /// One line for the log: which backend runs and, with `automatic`, why.
  const std::string& backendNotice() const;

  /// Adds a kinematic body and returns its number, counted from 0. It takes part once it has a pose.
  std::size_t addBody(const std::string& name, std::shared_ptr<const DistanceField> field);
  /// Tells where a body is at a time [s, of this simulator]; see Motion. @throws InvalidParameter naming the
  /// body
  void appendPose(std::size_t body, double time, const Eigen::Isometry3d& pose);
  /// From now on the body rests at `pose`, wherever it was: sand is moved out of its way, and gets no speed
  /// from the jump. What was appended before is forgotten. @throws InvalidParameter naming the body
  void placeBody(std::size_t body, const Eigen::Isometry3d& pose);
  /// Takes a body away: sand that it held up falls. Its number is not used again.
  void removeBody(std::size_t body);
  /// @throws InvalidParameter
  void addPour(const Pour& pour);

  /// Changes the sand of a region now. Returns by how much it grew [m³]; the ledger counts it as poured or
  /// left. @throws InvalidParameter also if the region lies outside of the grid
  double edit(const Edit& edit);

  /// Gives the sand of many cells other depths now, or other surfaces, as `edit` does; the others keep
  /// theirs. Returns by how much it grew [m³]; the ledger counts it as poured or left.
  /// @param operation set or level @throws InvalidParameter also for numbers that are not finite, or depths
  /// that are negative: then nothing has changed
  double setSand(EditOperation operation, const CellValues& cells);
  /// From now on the sand is of this kind; all of it wakes up, and whatever no longer holds slides. The sand
  /// goes on as one that was built with the material and took over this one's snapshot. What a map gave at
  /// the start stays. @throws InvalidParameter also for a value other than the present one where a map gives
  /// it
  void setMaterial(const Material& material);
  /// The same for gravity, in the grid's frame [m/s²]. @throws InvalidParameter
  void setGravity(const Eigen::Vector3d& gravity);

  Snapshot snapshot() const;
  /// Goes on from a snapshot of a simulator that was built from the same parameters, pours and bodies: with
  /// the same bits. Parameters stay those of this simulator, whatever they were when the snapshot was taken.
  /// @throws InvalidParameter if it does not fit
  void restore(const Snapshot& snapshot);

  /// Runs the sand on by `duration` [s] exactly. @throws InvalidParameter when negative, not finite, or when
  /// a fixed step breaks its bound
  void advance(double duration);
  /// The same until a time [s]: to no end that is a sum of roundings.
  void advanceTo(double time);
  /// The same, but the GPU goes on by itself meanwhile. Whatever is asked next waits for it, and throws what
  /// advanceTo would have thrown; all but collectFields.
  void beginAdvanceTo(double time);
  double time() const;  ///< [s] since construction

  Fields fields() const;
  /// The fields as they are now start on their way from the GPU. What has changed is sent, while the sand may
  /// go on.
  void requestFields();
  /// The fields that were requested the last time; valid until anything else is asked for but the time and
  /// the progress. On the GPU, whatever needs the fields is a request.
  const Fields& collectFields();
  /// Windows that hold all cells in which the fields that were collected last differ from those that were
  /// collected before this was asked the last time; the whole map the first time, and where the bed is
  /// another or bodies are the first ones.
  std::vector<Window> takeChanges();
  /// The grains as they are now, which go on once at the end of each advance; none without
  /// SimulatorParameters::grains. What of them is seen, and where, grainCloud tells of any copy.
  Grains grains() const;
  /// All at once: on the CPU it reads the cells where they lie, on the GPU it is a request. The three that
  /// follow do the same for one of them.
  SandFigures figures() const;
  Ledger ledger() const;
  const Progress& progress() const;
  double maxSpeed() const;          ///< of the sand now [m/s]
  std::size_t activeCells() const;  ///< cells whose sand moves now
  double bodyOverlap() const;       ///< sand inside bodies now [m³]
  /// What each body that has a pose does to the sand now, by name and, of one name, by number. Computed on
  /// the host when it is asked. @param now fields() @throws InvalidParameter if there are not so many cells
  std::vector<SandContact> contacts(const Fields& now) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace shallow_sand
