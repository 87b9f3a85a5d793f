# The plugin for rviz: display and tools. Needs Qt's moc for classes with signals and slots.
find_package(Qt5 REQUIRED COMPONENTS Widgets)
find_package(pluginlib REQUIRED)

file(GLOB rviz_sources CONFIGURE_DEPENDS src/rviz/*.cpp)
file(GLOB rviz_headers CONFIGURE_DEPENDS include/shallow_sand/rviz/*.h)
add_library(shallow_sand_rviz SHARED ${rviz_sources} ${rviz_headers})
set_target_properties(shallow_sand_rviz PROPERTIES AUTOMOC ON)
target_compile_definitions(shallow_sand_rviz PRIVATE QT_NO_KEYWORDS)
# Vectors of OGRE 1.9 have an assignment of their own and no copy constructor.
target_compile_options(shallow_sand_rviz PUBLIC -Wno-deprecated-copy)
target_include_directories(shallow_sand_rviz SYSTEM PUBLIC ${rviz_INCLUDE_DIRS} ${pluginlib_INCLUDE_DIRS})
target_link_libraries(shallow_sand_rviz
  PUBLIC shallow_sand_client ${rviz_LIBRARIES} ${pluginlib_LIBRARIES} Qt5::Widgets)

install(TARGETS shallow_sand_rviz LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(FILES rviz_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
