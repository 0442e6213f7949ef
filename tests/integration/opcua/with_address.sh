#!/bin/sh
# with_address.sh COMMAND [ARG...]: runs COMMAND in a network namespace with an address that is not one of the loopback network,
# named by CELLMIRROR_TEST_ADDRESS. Status 77 where that is not possible.
PATH=$PATH:/usr/sbin:/sbin
for spaces in "unshare --net" "unshare --map-root-user --net"; do
  $spaces true 2>/dev/null || continue
  CELLMIRROR_TEST_ADDRESS=192.0.2.1 exec $spaces sh -c 'ip link set lo up && ip address add 192.0.2.1/32 dev lo || exit 77; exec "$@"' sh "$@"
done
echo "skipped: no network namespace here" >&2
exit 77
