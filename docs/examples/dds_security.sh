#!/bin/sh
# Makes what DDS security needs for the members of one cell: a CA, a certificate and key for each member, a governance
# document and permissions. Run it on a machine of its own: who has ca.key can make further members.
#
#     dds_security.sh FOLDER MEMBER...      # e.g. dds_security.sh security gateway arm
#
# A member that exists is left as it is, and so is the CA. To let a member publish or subscribe less, edit
# MEMBER_permissions.xml and run this again: permissions are signed each time.
#
# SPDX-License-Identifier: Apache-2.0
set -eu
[ $# -ge 2 ] || { echo "usage: dds_security.sh FOLDER MEMBER..." >&2; exit 2; }
folder=$1
shift
days=3650
umask 077
mkdir -p "$folder"
cd "$folder"

new_key="-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes"
sign() {  # document.xml document.p7s
  openssl smime -sign -in "$1" -text -out "$2" -signer ca.pem -inkey ca.key
}

if [ ! -e ca.pem ]; then
  openssl req -x509 $new_key -keyout ca.key -out ca.pem -days $days -subj "/CN=cell CA" 2>openssl.log
fi

# Nobody joins without a certificate of the CA, and everything is encrypted.
cat >governance.xml <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>232</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>ENCRYPT</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>NONE</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
XML
sign governance.xml governance.p7s

for member in "$@"; do
  if [ ! -e "$member.pem" ]; then
    openssl req $new_key -keyout "$member.key" -out "$member.csr" -subj "/CN=$member" 2>openssl.log
    openssl x509 -req -in "$member.csr" -CA ca.pem -CAkey ca.key -CAcreateserial -out "$member.pem" -days $days 2>openssl.log
    rm "$member.csr"
  fi
  [ -e "${member}_permissions.xml" ] || cat >"${member}_permissions.xml" <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="$member">
      <subject_name>CN=$member</subject_name>
      <validity>
        <not_before>2020-01-01T00:00:00</not_before>
        <not_after>2050-01-01T00:00:00</not_after>
      </validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>232</max></id_range></domains>
        <publish><topics><topic>*</topic></topics></publish>
        <subscribe><topics><topic>*</topic></topics></subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
XML
  sign "${member}_permissions.xml" "${member}_permissions.p7s"
done
rm -f openssl.log
