#!/bin/sh
# with_veth.sh COMMAND [ARG...]: runs COMMAND in a network namespace with an interface that carries IPv6 multicast (Linux's
# loopback does not), named by CELLMIRROR_TEST_IPV6_INTERFACE. Status 77 where that is not possible.
PATH=$PATH:/usr/sbin:/sbin
setup='
ip link set lo up && ip link add veth_a type veth peer name veth_b && ip link set veth_a up && ip link set veth_b up || exit 77
for i in $(seq 100); do
  ip -6 address show dev veth_a scope link | grep inet6 | grep -qv tentative && break
  sleep 0.1
done
'
for spaces in "unshare --net" "unshare --map-root-user --net"; do
  $spaces true 2>/dev/null || continue
  CELLMIRROR_TEST_IPV6_INTERFACE=veth_a exec $spaces sh -c "$setup exec \"\$@\"" sh "$@"
done
echo "skipped: no network namespace here" >&2
exit 77
