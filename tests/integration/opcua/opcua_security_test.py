"""Who may read: on this machine everybody, beyond it who is encrypted and trusted. Runs in a network namespace (with_address.sh)."""

import os
import stat
import unittest

import bridge as b
import gateway as g

ADDRESS = os.environ.get("CELLMIRROR_TEST_ADDRESS", "")


class Security(unittest.TestCase):
    def setUp(self):
        self.scratch = g.Scratch()
        self.addCleanup(self.scratch.remove)

    def started(self, bind, *arguments):
        bridge = b.Bridge(self.scratch, *arguments, bind=bind)
        self.addCleanup(bridge.close)
        return bridge

    def session(self, bridge, mode, policy):
        return bridge.ask("session", mode, policy, self.scratch.root / "client")

    def test_on_this_machine_with_and_without_encryption(self):
        bridge = self.started("127.0.0.1")
        for mode, policy in (("None", "None"), ("SignAndEncrypt", "Basic256Sha256"), ("SignAndEncrypt", "Aes256_Sha256_RsaPss"), ("Sign", "Aes128_Sha256_RsaOaep")):
            self.assertIn("uris", self.session(bridge, mode, policy), (mode, policy))
        self.assertFalse((bridge.state / "pki").exists())

    def test_beyond_it_only_encrypted_and_trusted(self):
        bridge = self.started(ADDRESS)
        offered = bridge.ask("endpoints")
        self.assertEqual({one["mode"] for one in offered}, {"Sign", "SignAndEncrypt"})
        self.assertNotIn("None", {one["policy"] for one in offered})
        self.assertIn("refused", self.session(bridge, "None", "None"))
        self.assertIn("refused", self.session(bridge, "SignAndEncrypt", "Basic256Sha256"))
        rejected = list((bridge.state / "pki" / "rejected").iterdir())
        self.assertEqual(len(rejected), 1)
        bridge.wait_for(f"1 client certificates are not trusted: see {bridge.state}/pki/rejected")
        rejected[0].rename(bridge.state / "pki" / "trusted" / "certs" / rejected[0].name)
        self.assertTrue(g.eventually(lambda: "uris" in self.session(bridge, "SignAndEncrypt", "Basic256Sha256"), every=0.5))
        self.assertIn("refused", self.session(bridge, "None", "None"))
        bridge.close()
        self.assertIn("uris", self.session(self.started(ADDRESS), "SignAndEncrypt", "Basic256Sha256"))

    def test_a_client_accepted_on_this_machine_is_not_trusted_beyond_it(self):
        bridge = self.started("127.0.0.1")
        self.assertIn("uris", self.session(bridge, "SignAndEncrypt", "Basic256Sha256"))
        bridge.close()
        self.assertIn("refused", self.session(self.started(ADDRESS), "SignAndEncrypt", "Basic256Sha256"))

    def test_certificates_that_nobody_asked_for_do_not_fill_the_disk(self):
        bridge = self.started(ADDRESS)
        rejected = bridge.state / "pki" / "rejected"
        for number in range(200):
            (rejected / f"{number}.pem").write_text("x")
        self.assertTrue(g.eventually(lambda: len(list(rejected.iterdir())) <= 64))

    def test_unencrypted_where_asked(self):
        self.assertIn("uris", self.session(self.started(ADDRESS, "--allow-unencrypted"), "None", "None"))

    def test_the_key_is_for_this_user_only(self):
        bridge = self.started("127.0.0.1")
        for place in [bridge.state, *bridge.state.rglob("*")]:
            self.assertEqual(stat.S_IMODE(place.stat().st_mode) & 0o077, 0, place)
        key = bridge.state / "pki-loopback" / "own" / "private" / "private_key.pem"
        self.assertEqual(stat.S_IMODE(key.stat().st_mode), 0o600)


if __name__ == "__main__":
    b.main()
