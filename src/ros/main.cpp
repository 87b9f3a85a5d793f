#include <ros/ros.h>

#include <iostream>

#include "shallow_sand/ros/parameter_table.h"
#include "shallow_sand/ros/sand_node.h"

int main(int argument_count, char** arguments) {
  if (argument_count == 2 && std::string(arguments[1]) == "--parameters") {
    std::cout << shallow_sand::parameterMarkdown();
    return 0;
  }
  ros::init(argument_count, arguments, "sand_node");
  // ROS shuts its log down with the last handle; this one outlives the node, so that its end can be told.
  const ros::NodeHandle handle;
  // For the clock and interactive markers; the node takes all else from a queue of its own.
  ros::AsyncSpinner spinner(1);
  spinner.start();
  try {
    shallow_sand::SandNode(handle, ros::NodeHandle("~")).run([] { return true; });
  } catch (const shallow_sand::SceneError& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  } catch (const shallow_sand::InvalidParameter& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("sand_node: " << error.what());
    return 1;
  }
  return 0;
}
