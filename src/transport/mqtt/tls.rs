//! TLS with rustls: trusted roots, client certificates, explanation of certificate errors. Without the feature
//! `plant-tls`, TLS is not available, and settings with TLS are an error.

use thiserror::Error;

/// Trusted root certificates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trust {
    /// The roots of the operating system.
    System,
    /// Only these root certificates, in PEM format.
    Roots(Vec<u8>),
}

/// Client certificate, in PEM format.
#[derive(Clone, PartialEq, Eq)]
pub struct Identity {
    /// The certificate and its chain, in PEM format.
    pub certificates: Vec<u8>,
    /// The private key, in PEM format.
    pub key: Vec<u8>,
}

/// Error of the certificate check or the TLS handshake.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TlsError {
    /// The issuer of the broker's certificate is not trusted.
    #[error("this computer does not trust the issuer of the broker's certificate")]
    UnknownIssuer,
    /// The certificate is for another host name.
    #[error("the broker's certificate is for another name")]
    WrongName,
    /// The certificate has expired.
    #[error("the broker's certificate has expired")]
    Expired,
    /// The certificate is not valid yet.
    #[error("the broker's certificate is not valid yet")]
    NotYetValid,
    /// The certificate was revoked.
    #[error("the broker's certificate was revoked")]
    Revoked,
    /// The certificate is not valid for another reason.
    #[error("the broker's certificate is not valid: {0}")]
    Certificate(String),
    /// The port does not use TLS.
    #[error("the broker does not use TLS on this port")]
    NoTls,
    /// The broker rejects the certificate of this client, or requires a certificate.
    #[error("the broker does not accept this client's certificate ({0})")]
    Rejected(String),
    /// The two sides have no common TLS version or cipher.
    #[error("no common TLS version or cipher ({0})")]
    NothingInCommon(String),
    /// A local certificate or key is not valid.
    #[error("{0}")]
    Setup(String),
    /// Any other TLS error.
    #[error("TLS: {0}")]
    Other(String),
}

#[cfg(feature = "plant-tls")]
mod rustls_link {
    use std::fmt;
    use std::io;
    use std::sync::Arc;

    use tokio::net::TcpStream;
    use tokio_rustls::TlsConnector;
    use tokio_rustls::client::TlsStream;
    use tokio_rustls::rustls::pki_types::pem::PemObject as _;
    use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
    use tokio_rustls::rustls::{
        AlertDescription, CertificateError, ClientConfig, Error, RootCertStore, crypto::ring::default_provider,
    };

    use super::{Identity, TlsError, Trust};

    /// TLS settings for a broker.
    pub struct Tls {
        connector: TlsConnector,
        name: ServerName<'static>,
    }

    impl fmt::Debug for Tls {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "TLS to {:?}", self.name)
        }
    }

    impl Tls {
        /// Creates the settings for a broker with this host name or address.
        ///
        /// # Errors
        /// A certificate or key is not valid, or the system has no root certificates.
        pub fn new(host: &str, trust: &Trust, identity: Option<&Identity>) -> Result<Self, TlsError> {
            let name = ServerName::try_from(host.to_owned())
                .map_err(|_| TlsError::Setup(format!("'{host}' is not a valid server name")))?;
            let builder = ClientConfig::builder_with_provider(Arc::new(default_provider()))
                .with_safe_default_protocol_versions()
                .map_err(|error| TlsError::Other(error.to_string()))?
                .with_root_certificates(roots(trust)?);
            let config = match identity {
                None => builder.with_no_client_auth(),
                Some(Identity { certificates, key }) => {
                    let chain = certificates_of(certificates, "the certificate of this client")?;
                    let key = PrivateKeyDer::from_pem_slice(key).map_err(|_| {
                        TlsError::Setup("the key of this client is not a private key in PEM".to_owned())
                    })?;
                    builder.with_client_auth_cert(chain, key).map_err(|error| {
                        TlsError::Setup(format!("certificate and key of this client do not match: {error}"))
                    })?
                }
            };
            Ok(Self { connector: TlsConnector::from(Arc::new(config)), name })
        }

        pub(in super::super) async fn connect(&self, stream: TcpStream) -> Result<TlsStream<TcpStream>, TlsError> {
            let connected = self.connector.connect(self.name.clone(), stream).await;
            connected.map_err(|error| {
                TlsError::of(&error).unwrap_or_else(|| match error.kind() {
                    io::ErrorKind::UnexpectedEof | io::ErrorKind::ConnectionReset => TlsError::NoTls,
                    _ => TlsError::Other(super::super::super::plain(&error)),
                })
            })
        }
    }

    fn roots(trust: &Trust) -> Result<RootCertStore, TlsError> {
        let mut store = RootCertStore::empty();
        match trust {
            Trust::System => {
                let found = rustls_native_certs::load_native_certs();
                let (_, _) = store.add_parsable_certificates(found.certs);
                if store.is_empty() {
                    return Err(TlsError::Setup("this computer has no CA certificates".to_owned()));
                }
            }
            Trust::Roots(pem) => {
                for certificate in certificates_of(pem, "the CA certificate")? {
                    store
                        .add(certificate)
                        .map_err(|error| TlsError::Setup(format!("the CA certificate is not valid: {error}")))?;
                }
            }
        }
        Ok(store)
    }

    fn certificates_of(pem: &[u8], what: &str) -> Result<Vec<CertificateDer<'static>>, TlsError> {
        let found = CertificateDer::pem_slice_iter(pem).collect::<Result<Vec<_>, _>>();
        match found {
            Ok(found) if !found.is_empty() => Ok(found),
            _ => Err(TlsError::Setup(format!("{what} is not a certificate in PEM"))),
        }
    }

    impl TlsError {
        /// Returns the TLS error in an I/O error; `None` if the error does not come from rustls.
        pub(in super::super) fn of(error: &io::Error) -> Option<Self> {
            let error = error.get_ref()?.downcast_ref::<Error>()?;
            Some(match error {
                Error::InvalidCertificate(why) => match why {
                    CertificateError::UnknownIssuer => Self::UnknownIssuer,
                    CertificateError::NotValidForName | CertificateError::NotValidForNameContext { .. } => {
                        Self::WrongName
                    }
                    CertificateError::Expired | CertificateError::ExpiredContext { .. } => Self::Expired,
                    CertificateError::NotValidYet | CertificateError::NotValidYetContext { .. } => Self::NotYetValid,
                    CertificateError::Revoked => Self::Revoked,
                    why => Self::Certificate(why.to_string()),
                },
                Error::InvalidMessage(_) => Self::NoTls,
                Error::PeerIncompatible(why) => Self::NothingInCommon(format!("{why:?}")),
                Error::AlertReceived(alert) => match alert {
                    AlertDescription::ProtocolVersion
                    | AlertDescription::HandshakeFailure
                    | AlertDescription::InsufficientSecurity => Self::NothingInCommon(format!("{alert:?}")),
                    alert => Self::Rejected(format!("{alert:?}")),
                },
                error => Self::Other(error.to_string()),
            })
        }
    }
}

#[cfg(not(feature = "plant-tls"))]
mod rustls_link {
    use std::io;

    use tokio::net::TcpStream;

    use super::{Identity, TlsError, Trust};

    /// TLS settings. They cannot be created, because this build has no TLS.
    #[derive(Debug)]
    pub enum Tls {}

    impl Tls {
        /// Returns the error that this build has no TLS.
        pub fn new(_: &str, _: &Trust, _: Option<&Identity>) -> Result<Self, TlsError> {
            Err(TlsError::Setup("this armctl was built without TLS (feature plant-tls)".to_owned()))
        }

        #[expect(clippy::unused_async, reason = "the other version waits")]
        pub(in super::super) async fn connect(&self, _: TcpStream) -> Result<TcpStream, TlsError> {
            match *self {}
        }
    }

    impl TlsError {
        pub(in super::super) fn of(_: &io::Error) -> Option<Self> {
            None
        }
    }
}

pub use self::rustls_link::Tls;
