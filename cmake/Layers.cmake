# The one place that says which folder may link (and include) which. cellmirror_library() refuses anything else, and
# tests/support/check_includes.py reads this table to check the #include lines.
# Format: folder: folders it may use directly or through another.
set(CELLMIRROR_LAYERS
  "rt_core/base:"
  "rt_core/rt: rt_core/base"
  "rt_core/ports: rt_core/base"
  "ipc/wire: rt_core/base rt_core/ports"
  "ipc/sandbox: rt_core/base rt_core/rt"
  "rt_core/kinematics: rt_core/base rt_core/ports"
  "rt_core/inverse_kinematics: rt_core/base rt_core/ports rt_core/kinematics"
  "rt_core/motion: rt_core/base rt_core/ports rt_core/kinematics"
  "rt_core/planning: rt_core/base rt_core/ports rt_core/kinematics rt_core/inverse_kinematics rt_core/motion rt_core/cell"
  "rt_core/geometry: rt_core/base"
  "rt_core/cell: rt_core/base rt_core/ports rt_core/kinematics rt_core/geometry"
  "rt_core/collision: rt_core/base rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell"
  "rt_core/ranging: rt_core/base rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell"
  "rt_core/haptics: rt_core/base rt_core/ports rt_core/kinematics"
  "rt_core/dynamics: rt_core/base rt_core/ports rt_core/kinematics rt_core/cell"
  "rt_core/contact_model: rt_core/base rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell rt_core/collision rt_core/haptics"
  "rt_core/tissue/description: rt_core/base rt_core/ports rt_core/geometry"
  "rt_core/tissue/body: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description"
  "rt_core/tissue/contact: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description rt_core/tissue/body"
  "rt_core/tissue/effects: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact"
  "rt_core/tissue/instruments: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects"
  "rt_core/tissue: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments"
  "rt_core/volume: rt_core/base rt_core/ports"
  "rt_core/engine: rt_core/base rt_core/rt rt_core/ports rt_core/kinematics rt_core/motion rt_core/haptics"
  "config/mesh_message: rt_core/base rt_core/ports rt_core/geometry"
  "config/mesh_reader: config/mesh_message ipc/sandbox rt_core/base rt_core/rt rt_core/ports rt_core/geometry"
  "config/volume_message: rt_core/base"
  "config/volume_reader: config/volume_message ipc/sandbox rt_core/base rt_core/rt"
  "config/volume: rt_core/base rt_core/rt rt_core/ports ipc/sandbox config/volume_message"
  "config/msh: rt_core/base rt_core/ports rt_core/geometry rt_core/tissue/description"
  "config: rt_core/base rt_core/rt rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell rt_core/collision rt_core/haptics rt_core/tissue/description rt_core/volume ipc/sandbox config/mesh_message config/msh config/volume_message config/volume"
  "config/command_line: rt_core/base"
  "drivers/can: rt_core/base rt_core/rt rt_core/ports ipc/wire"
  "drivers/dds/message: rt_core/base rt_core/rt rt_core/ports ipc/sandbox"
  "drivers/dds/process: drivers/dds/message ipc/sandbox rt_core/base rt_core/rt rt_core/ports"
  "drivers/dds: rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/sandbox drivers/dds/message"
  "drivers/rtde: rt_core/base rt_core/rt rt_core/ports"
  "drivers/mqtt/message: rt_core/base rt_core/rt ipc/sandbox"
  "drivers/mqtt/process: drivers/mqtt/message ipc/sandbox rt_core/base rt_core/rt"
  "drivers/mqtt: rt_core/base rt_core/rt rt_core/ports ipc/sandbox drivers/mqtt/message"
  "drivers/haptic: rt_core/base rt_core/rt rt_core/ports ipc/wire"
  "drivers/footswitch: rt_core/base rt_core/rt rt_core/ports ipc/wire"
  "rt_core/scene: rt_core/base rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell"
  "drivers/display: rt_core/base rt_core/rt rt_core/ports rt_core/geometry rt_core/volume"
  "ipc/runtime: rt_core/base"
  "ipc/sysv: rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/runtime"
  "ipc/control: rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/runtime"
  "ipc/foxglove: rt_core/base"
  "ipc/web: rt_core/base rt_core/rt rt_core/ports ipc/runtime ipc/foxglove"
  "ipc/service_manager: rt_core/base rt_core/rt"
  "ipc/record: rt_core/base"
  "scripts/lang: rt_core/base rt_core/ports scripts/programs/program scripts/programs/languages"
  "scripts/commands: rt_core/base rt_core/ports scripts/lang"
  "scripts/runner: rt_core/base rt_core/ports scripts/lang scripts/commands"
  "scripts/programs/program: rt_core/base rt_core/ports"
  "scripts/programs/irdata: rt_core/base rt_core/ports scripts/programs/program"
  "scripts/programs/srcl: rt_core/base rt_core/ports scripts/programs/program"
  "scripts/programs/jet: rt_core/base rt_core/ports scripts/programs/program"
  "scripts/programs/crcl: rt_core/base rt_core/ports scripts/programs/program"
  "scripts/programs/rapid: rt_core/base rt_core/ports scripts/programs/program"
  "scripts/programs/languages: rt_core/base rt_core/ports scripts/programs/program scripts/programs/irdata scripts/programs/srcl scripts/programs/jet scripts/programs/crcl scripts/programs/rapid"
  "scripts/programs/controller: rt_core/base rt_core/ports scripts/lang scripts/commands scripts/programs/program"
  "sim_devices/base: rt_core/base ipc/sysv"
  "sim_devices/haptic: sim_devices/haptic sim_devices/base rt_core/base rt_core/ports ipc/wire ipc/sysv config/command_line"
  "sim_devices/footswitch: sim_devices/footswitch sim_devices/base rt_core/base ipc/wire ipc/sysv config/command_line"
  "sim_devices/camera: sim_devices/camera sim_devices sim_devices/base rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/runtime ipc/sysv drivers/can drivers/dds drivers/rtde config/command_line"
  "sim_devices: sim_devices sim_devices/base rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/runtime ipc/sysv drivers/can drivers/dds drivers/rtde config/command_line"
  "app/plot: rt_core/base"
  "app/console: rt_core/base rt_core/cell config"
  "app/snapshot: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/cell rt_core/collision rt_core/haptics rt_core/dynamics rt_core/tissue/description rt_core/engine scripts/runner scripts/programs/controller"
  "app/io: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/scene rt_core/engine config drivers/can drivers/dds drivers/rtde drivers/haptic ipc/sysv app/snapshot"
  "app/owner: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/kinematics rt_core/motion rt_core/cell rt_core/planning rt_core/collision rt_core/haptics rt_core/scene rt_core/tissue/description rt_core/engine config drivers/footswitch ipc/sysv scripts/programs/program scripts/programs/jet scripts/programs/languages scripts/lang scripts/commands scripts/runner scripts/programs/controller app/snapshot app/io"
  "app/workers: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/geometry rt_core/cell rt_core/collision rt_core/ranging rt_core/haptics rt_core/dynamics rt_core/contact_model rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments rt_core/tissue rt_core/engine app/snapshot"
  "app/render: rt_core/base rt_core/rt rt_core/ports rt_core/cell rt_core/dynamics rt_core/scene rt_core/engine config drivers/display app/snapshot"
  "app/report: rt_core/base rt_core/rt rt_core/ports rt_core/motion ipc/wire ipc/sandbox rt_core/cell rt_core/dynamics rt_core/scene rt_core/engine ipc/sysv ipc/control ipc/foxglove ipc/web app/snapshot"
  "app/alarms: rt_core/base rt_core/rt rt_core/ports rt_core/engine app/snapshot app/io app/report"
  "app/recording_layout: rt_core/base rt_core/rt rt_core/ports rt_core/kinematics rt_core/motion rt_core/haptics rt_core/engine ipc/record"
  "app/recording: rt_core/base rt_core/rt rt_core/ports ipc/wire drivers/can drivers/dds ipc/record app/plot app/recording_layout"
  "app/replay: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/kinematics rt_core/motion rt_core/haptics rt_core/engine drivers/can drivers/dds ipc/record app/recording_layout app/recording"
  "app/recorder: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/engine drivers/can drivers/dds ipc/record app/snapshot app/io app/recording_layout rt_core/kinematics rt_core/motion rt_core/haptics rt_core/cell"
  "app/playback: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/kinematics rt_core/motion rt_core/haptics rt_core/engine rt_core/cell drivers/can drivers/dds ipc/record app/snapshot app/recording_layout app/recording app/replay"
  "app/live: rt_core/base rt_core/rt rt_core/ports ipc/wire rt_core/engine drivers/can drivers/dds ipc/record app/snapshot app/io app/recording_layout rt_core/cell rt_core/collision ipc/runtime ipc/foxglove ipc/web app/recorder"
  "app/kinematics: rt_core/base rt_core/ports rt_core/kinematics rt_core/inverse_kinematics rt_core/cell config config/command_line app/plot"
  "app/proximity: rt_core/base rt_core/rt rt_core/ports rt_core/geometry rt_core/cell rt_core/collision rt_core/ranging config app/plot app/console"
  "app/pictures: rt_core/base rt_core/ports rt_core/cell rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments rt_core/tissue rt_core/scene config drivers/display ipc/runtime ipc/control app/owner app/render"
  "app/new_cell: rt_core/base rt_core/ports rt_core/cell config drivers/can app/io"
  "app/volume_info: rt_core/base rt_core/ports config config/volume app/plot"
  "app/simulation: rt_core/base rt_core/rt rt_core/ports rt_core/motion rt_core/geometry rt_core/collision rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments rt_core/tissue rt_core/engine config scripts/programs/controller app/plot app/console app/snapshot app/owner app/workers"
  "app/wall: rt_core/base rt_core/rt rt_core/ports rt_core/kinematics rt_core/geometry rt_core/cell rt_core/collision rt_core/haptics rt_core/tissue/description ipc/wire config config/volume ipc/sandbox config/msh drivers/dds ipc/runtime ipc/foxglove ipc/web"
  "app/gateway: rt_core/base rt_core/rt rt_core/ports rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments rt_core/tissue ipc/wire ipc/sandbox rt_core/engine config drivers/dds drivers/rtde drivers/mqtt ipc/sysv ipc/control ipc/foxglove ipc/web scripts/lang scripts/commands app/snapshot app/io app/owner app/workers app/render app/report app/pictures config/volume ipc/record app/recorder app/live app/alarms app/recording_layout app/recording app/replay app/playback"
  "app: *"
  "tests: *")

# In the order in which CMake has to see them.
set(CELLMIRROR_FOLDERS rt_core/base rt_core/rt rt_core/ports ipc/wire ipc/sandbox rt_core/kinematics rt_core/inverse_kinematics
  rt_core/motion rt_core/geometry rt_core/cell rt_core/planning rt_core/collision rt_core/ranging rt_core/haptics rt_core/dynamics rt_core/contact_model rt_core/tissue/description rt_core/tissue/body rt_core/tissue/contact rt_core/tissue/effects rt_core/tissue/instruments rt_core/tissue rt_core/volume rt_core/scene
  rt_core/engine config/mesh_message config/mesh_reader config/msh config/volume_message config/volume_reader config/volume config config/command_line drivers/can drivers/dds/message drivers/dds/process drivers/dds drivers/rtde drivers/mqtt/message drivers/mqtt/process drivers/mqtt drivers/haptic drivers/footswitch drivers/display ipc/runtime ipc/sysv ipc/control ipc/foxglove ipc/web ipc/service_manager ipc/record
  scripts/programs/program scripts/programs/irdata scripts/programs/srcl scripts/programs/jet scripts/programs/crcl scripts/programs/rapid scripts/programs/languages
  scripts/lang scripts/commands scripts/runner scripts/programs/controller
  sim_devices/base sim_devices/haptic sim_devices/footswitch sim_devices sim_devices/camera app/plot
  app/console app/snapshot app/io app/owner app/workers app/render app/report app/alarms app/kinematics app/proximity app/pictures app/simulation app/volume_info app/new_cell app/recording_layout app/recording app/replay app/playback app/recorder app/live app/wall app/gateway app tests)

function(cellmirror_allowed_folders folder result)
  foreach(row IN LISTS CELLMIRROR_LAYERS)
    string(REGEX MATCH "^([^:]+):(.*)$" _ "${row}")
    if(CMAKE_MATCH_1 STREQUAL folder)
      string(STRIP "${CMAKE_MATCH_2}" allowed)
      separate_arguments(allowed)
      set(${result} ${allowed} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "${folder} is not in the table of cmake/Layers.cmake: say there what it may use")
endfunction()

function(cellmirror_check_layer folder)
  cellmirror_allowed_folders(${folder} allowed)
  if("*" IN_LIST allowed)
    return()
  endif()
  foreach(used IN LISTS ARGN)
    if(NOT used IN_LIST allowed)
      message(FATAL_ERROR "${folder} may not use ${used}: cmake/Layers.cmake")
    endif()
  endforeach()
endfunction()
