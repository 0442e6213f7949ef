#!/usr/bin/env python3
"""Type hashes of the ROS 2 messages that drivers/dds has (RIHS01, REP 2011 and its hashing of type descriptions): computed from their
definitions. Prints the table of drivers/dds/type_hashes.cpp, or compares it: `ros2_type_hashes.py --check FILE`.

The definitions are those of common_interfaces, rcl_interfaces, unique_identifier_msgs, rmw_dds_common and ros-controls/control_msgs.
"""

import hashlib
import json
import re
import sys

# type_description_interfaces/msg/FieldType
IDS = {"int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9, "float32": 10, "float64": 11,
       "char": 3, "bool": 15, "byte": 16, "string": 17}
NESTED = 1
ARRAY, BOUNDED, UNBOUNDED = 48, 96, 144

COMMON = """
builtin_interfaces/msg/Time: int32 sec; uint32 nanosec
builtin_interfaces/msg/Duration: int32 sec; uint32 nanosec
std_msgs/msg/Header: builtin_interfaces/msg/Time stamp; string frame_id
std_msgs/msg/String: string data
std_msgs/msg/ColorRGBA: float32 r; float32 g; float32 b; float32 a
geometry_msgs/msg/Point: float64 x; float64 y; float64 z
geometry_msgs/msg/Vector3: float64 x; float64 y; float64 z
geometry_msgs/msg/Quaternion: float64 x; float64 y; float64 z; float64 w
geometry_msgs/msg/Pose: geometry_msgs/msg/Point position; geometry_msgs/msg/Quaternion orientation
geometry_msgs/msg/Transform: geometry_msgs/msg/Vector3 translation; geometry_msgs/msg/Quaternion rotation
geometry_msgs/msg/TransformStamped: std_msgs/msg/Header header; string child_frame_id; geometry_msgs/msg/Transform transform
geometry_msgs/msg/Twist: geometry_msgs/msg/Vector3 linear; geometry_msgs/msg/Vector3 angular
geometry_msgs/msg/Wrench: geometry_msgs/msg/Vector3 force; geometry_msgs/msg/Vector3 torque
geometry_msgs/msg/WrenchStamped: std_msgs/msg/Header header; geometry_msgs/msg/Wrench wrench
tf2_msgs/msg/TFMessage: geometry_msgs/msg/TransformStamped[] transforms
sensor_msgs/msg/JointState: std_msgs/msg/Header header; string[] name; float64[] position; float64[] velocity; float64[] effort
sensor_msgs/msg/Range: std_msgs/msg/Header header; uint8 radiation_type; float32 field_of_view; float32 min_range; float32 max_range; float32 range; float32 variance
sensor_msgs/msg/CompressedImage: std_msgs/msg/Header header; string format; uint8[] data
diagnostic_msgs/msg/KeyValue: string key; string value
diagnostic_msgs/msg/DiagnosticStatus: byte level; string name; string message; string hardware_id; diagnostic_msgs/msg/KeyValue[] values
diagnostic_msgs/msg/DiagnosticArray: std_msgs/msg/Header header; diagnostic_msgs/msg/DiagnosticStatus[] status
visualization_msgs/msg/UVCoordinate: float32 u; float32 v
visualization_msgs/msg/MeshFile: string filename; uint8[] data
visualization_msgs/msg/Marker: std_msgs/msg/Header header; string ns; int32 id; int32 type; int32 action; geometry_msgs/msg/Pose pose; geometry_msgs/msg/Vector3 scale; std_msgs/msg/ColorRGBA color; builtin_interfaces/msg/Duration lifetime; bool frame_locked; geometry_msgs/msg/Point[] points; std_msgs/msg/ColorRGBA[] colors; string texture_resource; sensor_msgs/msg/CompressedImage texture; visualization_msgs/msg/UVCoordinate[] uv_coordinates; string text; string mesh_resource; visualization_msgs/msg/MeshFile mesh_file; bool mesh_use_embedded_materials
visualization_msgs/msg/MarkerArray: visualization_msgs/msg/Marker[] markers
trajectory_msgs/msg/JointTrajectoryPoint: float64[] positions; float64[] velocities; float64[] accelerations; float64[] effort; builtin_interfaces/msg/Duration time_from_start
trajectory_msgs/msg/JointTrajectory: std_msgs/msg/Header header; string[] joint_names; trajectory_msgs/msg/JointTrajectoryPoint[] points
trajectory_msgs/msg/MultiDOFJointTrajectoryPoint: geometry_msgs/msg/Transform[] transforms; geometry_msgs/msg/Twist[] velocities; geometry_msgs/msg/Twist[] accelerations; builtin_interfaces/msg/Duration time_from_start
trajectory_msgs/msg/MultiDOFJointTrajectory: std_msgs/msg/Header header; string[] joint_names; trajectory_msgs/msg/MultiDOFJointTrajectoryPoint[] points
unique_identifier_msgs/msg/UUID: uint8[16] uuid
action_msgs/msg/GoalInfo: unique_identifier_msgs/msg/UUID goal_id; builtin_interfaces/msg/Time stamp
action_msgs/msg/GoalStatus: action_msgs/msg/GoalInfo goal_info; int8 status
action_msgs/msg/GoalStatusArray: action_msgs/msg/GoalStatus[] status_list
action_msgs/srv/CancelGoal_Request: action_msgs/msg/GoalInfo goal_info
action_msgs/srv/CancelGoal_Response: int8 return_code; action_msgs/msg/GoalInfo[] goals_canceling
rmw_dds_common/msg/Gid: uint8[16] data
rmw_dds_common/msg/NodeEntitiesInfo: string<256> node_namespace; string<256> node_name; rmw_dds_common/msg/Gid[] reader_gid_seq; rmw_dds_common/msg/Gid[] writer_gid_seq
rmw_dds_common/msg/ParticipantEntitiesInfo: rmw_dds_common/msg/Gid gid; rmw_dds_common/msg/NodeEntitiesInfo[] node_entities_info_seq
control_msgs/msg/JointTolerance: string name; float64 position; float64 velocity; float64 acceleration
control_msgs/msg/JointComponentTolerance: string joint_name; uint16 component; float64 position; float64 velocity; float64 acceleration
control_msgs/action/FollowJointTrajectory_Goal: trajectory_msgs/msg/JointTrajectory trajectory; trajectory_msgs/msg/MultiDOFJointTrajectory multi_dof_trajectory; control_msgs/msg/JointTolerance[] path_tolerance; control_msgs/msg/JointComponentTolerance[] component_path_tolerance; control_msgs/msg/JointTolerance[] goal_tolerance; control_msgs/msg/JointComponentTolerance[] component_goal_tolerance; builtin_interfaces/msg/Duration goal_time_tolerance
control_msgs/action/FollowJointTrajectory_Result: int32 error_code; string error_string
control_msgs/action/FollowJointTrajectory_SendGoal_Request: unique_identifier_msgs/msg/UUID goal_id; control_msgs/action/FollowJointTrajectory_Goal goal
control_msgs/action/FollowJointTrajectory_SendGoal_Response: bool accepted; builtin_interfaces/msg/Time stamp
control_msgs/action/FollowJointTrajectory_GetResult_Request: unique_identifier_msgs/msg/UUID goal_id
control_msgs/action/FollowJointTrajectory_GetResult_Response: int8 status; control_msgs/action/FollowJointTrajectory_Result result
control_msgs/action/FollowJointTrajectory_FeedbackMessage: unique_identifier_msgs/msg/UUID goal_id; control_msgs/action/FollowJointTrajectory_Feedback feedback
"""
P, M = "trajectory_msgs/msg/JointTrajectoryPoint", "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
STATE = (f"control_msgs/msg/JointTrajectoryControllerState: std_msgs/msg/Header header; string[] joint_names; {P} reference; {P} feedback; "
         f"{P} error; {P} output; string[] multi_dof_joint_names; {M} multi_dof_reference; {M} multi_dof_feedback; {M} multi_dof_error; "
         f"{M} multi_dof_output")
FEEDBACK = (f"control_msgs/action/FollowJointTrajectory_Feedback: std_msgs/msg/Header header; string[] joint_names; {P} desired; {P} actual; "
            f"{P} error; string[] multi_dof_joint_names; {M} multi_dof_desired; {M} multi_dof_actual; {M} multi_dof_error")
# What differs, by distribution.
JAZZY = STATE + "; float64 speed_scaling_factor\n" + FEEDBACK + "\n"
KILTED = STATE + "; float64 speed_scaling_factor\n" + FEEDBACK.replace(" error; string[]", " error; int32 index; string[]") + "; int32 multi_dof_index\n"
IRON = STATE + "\n" + FEEDBACK + "\n"

# Hashes that ROS 2's own generator has published (rosidl_generator_c's descriptions, rmw's logs), to check this program by.
PUBLISHED = {
    "sensor_msgs/msg/JointState": "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "sensor_msgs/msg/Range": "b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a",
    "builtin_interfaces/msg/Duration": "e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b",
    "geometry_msgs/msg/Transform": "beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc",
    "trajectory_msgs/msg/JointTrajectoryPoint": "de8907036d8bd45aac6f30cc9044a3d4a329c42cbf719aff7d95a584cfa532d7",
    "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint": "6ada1085b5ee64eaa069b074968e69f0e27c8c5e6f5bb0586dd1c834ef0e32b8",
}
PUBLISHED_IRON = {"control_msgs/msg/JointTrajectoryControllerState": "6cb9ac0858fc11b54bd6c0a46f032ea243c16856182276d8eb0875f6ce6a8335"}

# In the table: what the gateway reads and writes.
TOPICS = ["sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage", "std_msgs/msg/String", "sensor_msgs/msg/Range",
          "geometry_msgs/msg/WrenchStamped", "diagnostic_msgs/msg/DiagnosticArray", "visualization_msgs/msg/MarkerArray",
          "sensor_msgs/msg/CompressedImage", "trajectory_msgs/msg/JointTrajectory", "action_msgs/msg/GoalStatusArray",
          "action_msgs/srv/CancelGoal_Request", "action_msgs/srv/CancelGoal_Response",
          "control_msgs/action/FollowJointTrajectory_SendGoal_Request", "control_msgs/action/FollowJointTrajectory_SendGoal_Response",
          "control_msgs/action/FollowJointTrajectory_GetResult_Request", "control_msgs/action/FollowJointTrajectory_GetResult_Response",
          "control_msgs/msg/JointTrajectoryControllerState", "rmw_dds_common/msg/ParticipantEntitiesInfo"]
FEEDBACK_TYPE = "control_msgs/action/FollowJointTrajectory_FeedbackMessage"


def parse(text):
    types = {}
    for line in text.strip().splitlines():
        name, fields = line.split(": ", 1)
        types[name] = [tuple(field.strip().rsplit(" ", 1)) for field in fields.split(";")]
    return types


def field_type(written):
    array = re.fullmatch(r"(.*)\[(<=)?(\d*)\]", written)
    base, offset, capacity = written, 0, 0
    if array:
        base = array.group(1)
        offset = UNBOUNDED if not array.group(3) else BOUNDED if array.group(2) else ARRAY
        capacity = int(array.group(3) or 0)
    text = re.fullmatch(r"string<(\d+)>", base)
    if text:
        return {"type_id": 21 + offset, "capacity": capacity, "string_capacity": int(text.group(1)), "nested_type_name": ""}
    nested = "" if base in IDS else base
    return {"type_id": IDS.get(base, NESTED) + offset, "capacity": capacity, "string_capacity": 0, "nested_type_name": nested}


def described(types, name):
    return {"type_name": name, "fields": [{"name": field, "type": field_type(kind)} for kind, field in types[name]]}


def referenced(types, name, found):
    for field in described(types, name)["fields"]:
        nested = field["type"]["nested_type_name"]
        if nested and nested not in found:
            found.add(nested)
            referenced(types, nested, found)
    return found


def type_hash(types, name):
    document = {"type_description": described(types, name),
                "referenced_type_descriptions": [described(types, other) for other in sorted(referenced(types, name, set()))]}
    text = json.dumps(document, ensure_ascii=True, separators=(", ", ": "))
    return hashlib.sha256(text.encode()).hexdigest()


def dds_name(name):
    package, kind, message = name.split("/")
    return f"{package}::{kind}::dds_::{message}_"


def table():
    jazzy, kilted = parse(COMMON + JAZZY), parse(COMMON + KILTED)
    rows = [(dds_name(name), type_hash(jazzy, name)) for name in TOPICS]
    rows.append((dds_name(FEEDBACK_TYPE), type_hash(jazzy, FEEDBACK_TYPE)))
    rows.append((dds_name(FEEDBACK_TYPE) + " kilted", type_hash(kilted, FEEDBACK_TYPE)))
    return rows


def main():
    iron = parse(COMMON + IRON)
    for known in (PUBLISHED, PUBLISHED_IRON):
        for name, published in known.items():
            computed = type_hash(iron, name)
            if computed != published:
                print(f"{name}: computed {computed}, published {published}", file=sys.stderr)
                return 1
    if len(sys.argv) != 3:
        for name, value in table():
            print(name, value)
        return 0
    source = open(sys.argv[2], encoding="utf-8").read()
    missing = [f"{name} {value}" for name, value in table() if value not in source]
    for line in missing:
        print(f"{sys.argv[2]} has not {line}", file=sys.stderr)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
