#include <gtest/gtest.h>

#include <string>

#include "cuda_calls.h"
#include "parity.h"

namespace shallow_sand {
namespace {

class CudaErrors : public CudaSceneTest {
 protected:
  void TearDown() override {
    stopFailing();
    cudaGetLastError();  // forgets it, so that the next test begins as the first does
  }

  Simulator simulatorOn(Backend backend) const { return shallow_sand::simulatorOn(backend, scene_); }
};

void expectOneLineWith(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

/// What the CPU's notice says of the GPU, if the GPU has failed.
void expectCpuTookOver(const Simulator& simulator, const std::string& reason) {
  EXPECT_EQ(simulator.backend(), Backend::cpu);
  expectOneLineWith(reason, simulator.backendNotice());
  expectOneLineWith("running on the CPU", simulator.backendNotice());
}

TEST_F(CudaErrors, FullDeviceIsOneClearLineWhereverItIsMet) {
  const std::size_t before = allocationsHeld();
  std::size_t passing = 0;
  for (bool fails = true; fails; ++passing) {
    SCOPED_TRACE("after " + std::to_string(passing) + " allocations");
    failAllocations(0, passing);
    fails = false;
    try {
      simulatorOn(Backend::cuda);
    } catch (const std::runtime_error& problem) {
      fails = true;
      expectOneLineWith("memory", problem.what());
    }
    stopFailing();
    ASSERT_EQ(allocationsHeld(), before);
  }
  EXPECT_GT(passing, 1u);
}

TEST_F(CudaErrors, FullDeviceLeavesTheNextSimulatorAlone) {
  failAllocations(0);
  EXPECT_THROW(simulatorOn(Backend::cuda), std::runtime_error);
  stopFailing();
  Simulator simulator = simulatorOn(Backend::cuda);
  simulator.advance(scene_.frame);
  EXPECT_GT(simulator.progress().steps, 0u);
}

TEST_F(CudaErrors, AutomaticTakesTheCpuIfTheDeviceIsFull) {
  failAllocations(0);
  Simulator simulator = simulatorOn(Backend::automatic);
  expectCpuTookOver(simulator, "memory");
  simulator.advance(scene_.frame);
}

TEST_F(CudaErrors, AutomaticTakesTheCpuIfTheDeviceIsFullOfItsFields) {
  const std::size_t before = allocationsHeld();
  failAllocations(scene_.sand.depth.size() * sizeof(float));
  const Simulator simulator = simulatorOn(Backend::automatic);
  expectCpuTookOver(simulator, "memory");
  EXPECT_EQ(allocationsHeld(), before);
}

TEST_F(CudaErrors, AutomaticTakesTheCpuIfTheDriverIsTooOld) {
  failDeviceCount(cudaErrorInsufficientDriver);
  const std::size_t before = launches();
  Simulator simulator = simulatorOn(Backend::automatic);
  expectCpuTookOver(simulator, toldByRuntime(cudaErrorInsufficientDriver));
  simulator.advance(scene_.frame);
  EXPECT_EQ(launches(), before);
}

TEST_F(CudaErrors, CudaWithADriverThatIsTooOldIsAnError) {
  failDeviceCount(cudaErrorInsufficientDriver);
  try {
    simulatorOn(Backend::cuda);
    FAIL() << "no error";
  } catch (const InvalidParameter& problem) {
    expectOneLineWith(toldByRuntime(cudaErrorInsufficientDriver), problem.what());
  }
}

TEST_F(CudaErrors, LostDeviceIsAnErrorAndNeverASwitch) {
  for (const Backend backend : {Backend::cuda, Backend::automatic}) {
    SCOPED_TRACE(toString(backend));
    Simulator simulator = simulatorOn(backend);
    simulator.advance(scene_.frame);
    loseDevice(cudaErrorLaunchFailure, 1);
    const auto run = [&] {
      for (int frame = 0; frame < 10; ++frame) simulator.advance(scene_.frame);
    };
    EXPECT_THROW(run(), std::runtime_error);
    EXPECT_EQ(simulator.backend(), Backend::cuda);
    try {
      simulator.advance(scene_.frame);
      ADD_FAILURE() << "it went on";
    } catch (const std::runtime_error& problem) {
      expectOneLineWith(toldByRuntime(cudaErrorLaunchFailure), problem.what());
    }
    EXPECT_THROW(simulator.fields(), std::runtime_error);
    stopFailing();
  }
}

}  // namespace
}  // namespace shallow_sand
