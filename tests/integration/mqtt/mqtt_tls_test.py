"""TLS, certificates and passwords between the gateway and a broker."""

import json
import pathlib
import subprocess
import unittest

import brokers
import gateway as g

PASSWORD = "a-word-that-no-log-has"


def setUpModule():
    brokers.require()
    g.require("openssl", "openssl is not installed")


def openssl(folder, *arguments):
    subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True, timeout=g.PATIENCE_S)


def make_authority(folder, name):
    openssl(folder, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", f"/CN={name}",
            "-keyout", f"{name}.key", "-out", f"{name}.pem")


def make_certificate(folder, authority, name, address):
    (folder / "extensions").write_text(f"subjectAltName={address}\n")
    openssl(folder, "req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj", f"/CN={name}", "-keyout",
            f"{name}.key", "-out", f"{name}.csr")
    openssl(folder, "x509", "-req", "-in", f"{name}.csr", "-CA", f"{authority}.pem", "-CAkey", f"{authority}.key", "-CAcreateserial", "-days",
            "2", "-extfile", "extensions", "-out", f"{name}.pem")


class Tls(brokers.MqttCase):
    def setUp(self):
        self.scratch = g.Scratch(brokers.CELL)
        self.addCleanup(self.scratch.remove)
        self.folder = self.scratch.home / "security"
        self.folder.mkdir()
        make_authority(self.folder, "ca")
        make_authority(self.folder, "stranger")
        make_certificate(self.folder, "ca", "broker", "IP:127.0.0.1")
        make_certificate(self.folder, "ca", "gateway", "DNS:gateway")
        words = self.folder / "words"
        subprocess.run(["mosquitto_passwd", "-b", "-c", words, "gateway", PASSWORD], check=True, capture_output=True)
        self.secured = (f"cafile {self.folder}/ca.pem\ncertfile {self.folder}/broker.pem\nkeyfile {self.folder}/broker.key\n"
                        f"allow_anonymous false\npassword_file {words}\n")
        self.credentials(PASSWORD)

    def credentials(self, password):
        file = self.folder / "credentials"
        file.write_text(f"gateway\n{password}\n")
        file.chmod(0o600)

    def broker(self, settings=""):
        self.at = brokers.Broker(self.secured + settings)
        self.addCleanup(self.at.close)

    def has_problem(self, text):
        self.assertTrue(g.eventually(lambda: any(text in one for one in self.problems())), self.problems())
        self.assertNotIn(PASSWORD, self.gateway.output())

    def test_a_broker_with_tls_and_a_password(self):
        self.broker()
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials")
        self.start()
        self.credentials("wrong")
        self.at.kill()
        self.at.start()
        self.has_problem("credentials")
        self.credentials(PASSWORD)
        self.connected()
        self.assertNotIn(PASSWORD, self.gateway.output())

    def test_a_burst_of_commands_over_tls_is_answered_as_a_whole(self):
        self.broker()
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials", commands=True, commands_per_s=50)
        self.start()
        options = ["--cafile", str(self.folder / "ca.pem"), "-u", "gateway", "-P", PASSWORD]
        listener = brokers.Listener(self.at, f"{brokers.BASE}/reply", options)
        self.addCleanup(listener.close)
        lines = "".join(json.dumps({"command": f"ROBACT {brokers.ROBOT}", "id": i}) + "\n" for i in range(60))
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.at.port), "-t", f"{brokers.BASE}/command", "-l", "-q", "1",
                        *options], input=lines, text=True, check=True, timeout=g.PATIENCE_S)
        self.assertTrue(g.eventually(lambda: len(listener.all(f"{brokers.BASE}/reply")) == 60), len(listener.all(f"{brokers.BASE}/reply")))
        self.assertEqual(sorted(one["id"] for one in listener.all(f"{brokers.BASE}/reply")), list(range(60)))

    def test_certificates_of_both(self):
        self.broker("require_certificate true\n")
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials")
        self.start(connected=False)
        self.assertTrue(g.eventually(self.problems))
        self.gateway.close()
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials", certificate="security/gateway.pem",
                   key="security/gateway.key")
        self.start()

    def test_a_broker_that_another_authority_vouches_for_is_not_believed(self):
        self.broker()
        self.write(self.at, ca_file="security/stranger.pem", credentials="security/credentials")
        self.start(connected=False)
        self.has_problem("TLS failed")

    def test_the_name_in_the_certificate_counts(self):
        make_certificate(self.folder, "ca", "broker", "DNS:elsewhere")
        self.broker()
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials")
        self.start(connected=False)
        self.has_problem("TLS failed")

    def test_secrets_that_others_may_read_are_refused_by_check(self):
        self.broker()
        (self.folder / "credentials").chmod(0o644)
        (self.folder / "gateway.key").chmod(0o640)
        self.write(self.at, ca_file="security/ca.pem", credentials="security/credentials", certificate="security/gateway.pem",
                   key="security/gateway.key")
        done = self.scratch.cellmirror("check", str(self.scratch.cell_file))
        self.assertEqual(done.returncode, 1)
        for name in ("credentials", "gateway.key"):
            self.assertIn(f"chmod 600 {pathlib.Path(self.folder).resolve()}/{name}", done.stdout + done.stderr)


if __name__ == "__main__":
    g.main()
