// The OpenID provider that the tests start: node provider.mjs REDIRECT_URI. It prints its issuer, and
// lets anybody in under any name; ann is one of the yard.
import Provider from 'oidc-provider';
import { createServer } from 'node:http';

// Nobody reads what comes after the issuer.
console.info = console.error;
console.warn = console.error;

const redirect = process.argv[2];
const people = (id) => ({
  sub: id,
  name: `${id} of the yard`,
  preferred_username: id,
  email: `${id}@yard.example`,
  email_verified: true,
  groups: id === 'ann' ? ['yard'] : [],
});

const listening = createServer().listen(0, '127.0.0.1', () => {
  const issuer = `http://127.0.0.1:${listening.address().port}`;
  const provider = new Provider(issuer, {
    clients: [{ client_id: 'ships', client_secret: 'of the test & no other', redirect_uris: [redirect] }],
    pkce: { required: () => true },
    claims: {
      openid: ['sub'],
      profile: ['name', 'preferred_username'],
      email: ['email', 'email_verified'],
      groups: ['groups'],
    },
    findAccount: (_, id) => ({ accountId: id, claims: () => people(id) }),
  });
  listening.on('request', provider.callback());
  console.log(issuer);
});
